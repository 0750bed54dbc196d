#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/lists/simd/search.hpp"
#include "detp/sim/search/hit_collector.hpp"
#include "detp/sim/search/ray_search.hpp"
#include "detp/sim/search/run_memory.hpp"
#include "technique.hpp"

namespace detp::sim {
namespace {

/// Tests disc after disc against a chunk of rays that fits the cache.
template <bool counting>
class BruteForceSearch final : public RaySearch {
 public:
  BruteForceSearch(const Problem& problem, const std::stop_token& stop)
      : problem_(problem), check_(stop, "searching") {}

  void search(std::uint32_t first, std::uint32_t last, FoundPairs& hits) override {
    for (std::uint32_t d = 0; d < problem_.discs().size(); ++d) {
      const Disc disc = problem_.discs()[d];
      for (std::uint32_t r = first; r < last; ++r)
        if (counts_as_hit(problem_, problem_.rays()[r], disc)) hits.push_back({r, d});
      check_.after(last - first);
    }
    tally_.add(&Counts<std::uint64_t>::disc_tests, problem_.discs().size() * (last - first));
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tally_.counts(); }

 private:
  const Problem& problem_;
  StopCheck check_;
  Tally<counting> tally_;
};

template <bool counting>
void search_all(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  search_rays(
      problem, options,
      [&] { return make_in<RaySearch, BruteForceSearch<counting>>(*options.memory, problem, options.stop); }, outcome);
}

/// Tests every disc against every ray, in double. Builds nothing.
class PlainBruteForce final : public Index {
 public:
  void search(const Problem& problem, const RunOptions& options, Outcome& outcome) const override {
    add_checked_bytes("their sums", found_bytes(problem, options), problem, outcome);
    options.count ? search_all<true>(problem, options, outcome) : search_all<false>(problem, options, outcome);
    if (options.count) outcome.counts.visits = problem.discs().size();  // one list of all rays
  }
};

}  // namespace

std::unique_ptr<Index> prepare_brute_force(const Problem& problem, const Parameters&, const RunOptions& options) {
  if (options.engine == Engine::simd && stream::can_search(problem)) return stream::prepare_all(problem, options);
  return std::make_unique<PlainBruteForce>();
}

}  // namespace detp::sim
