#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/ray_search.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

class EachPair final : public RaySearch {
 public:
  EachPair(const Problem& problem, int step) : problem_(problem), step_(static_cast<std::uint32_t>(step)) {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    const auto discs = static_cast<std::uint32_t>(problem_.discs().size());
    for (std::uint32_t start = 0; start < step_; ++start)
      for (std::uint32_t d = start; d < discs; d += step_)
        for (std::uint32_t r = first; r < last; ++r)
          if (counts_as_hit(problem_, problem_.rays()[r], problem_.discs()[d])) hits.push_back({r, d});
    tally_.add(&Counts<std::uint64_t>::disc_tests, problem_.discs().size() * (last - first));
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tally_.counts(); }

 private:
  const Problem& problem_;
  std::uint32_t step_;
  Tally<true> tally_;
};

class EachPairIndex final : public Index {
 public:
  explicit EachPairIndex(int step) : step_(step) {}

  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes("their sums", found_bytes(problem, options), problem, outcome);
    search_rays(
        problem, options, [&] { return make_in<RaySearch, EachPair>(*options.memory, problem, step_); }, outcome);
  }

 private:
  int step_;
};

}  // namespace

std::unique_ptr<Index> prepare_each_pair(const Problem&, const Parameters& parameters, const RunOptions&) {
  return std::make_unique<EachPairIndex>(std::get<EachPairParameters>(parameters).step);
}

}  // namespace detp::sim
