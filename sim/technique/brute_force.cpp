#include "detp/sim/stop_check.hpp"
#include "detp/sim/stream/search.hpp"
#include "hit_collector.hpp"
#include "ray_search.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

/// A chunk of rays stays in the cache while disc after disc is tested against it.
template <bool counting>
class BruteForceSearch final : public RaySearch {
 public:
  BruteForceSearch(const Problem& problem, const std::stop_token& stop)
      : problem_(problem), check_(stop, "searching") {}

  void search(std::uint32_t first, std::uint32_t last, std::vector<Pair>& hits) override {
    for (std::uint32_t d = 0; d < problem_.discs.size(); ++d) {
      const Disc disc = problem_.discs[d];
      for (std::uint32_t r = first; r < last; ++r)
        if (counts_as_hit(problem_, problem_.rays[r], disc)) hits.push_back({r, d});
      check_.after(last - first);
    }
    tally_.add(&Counts<std::uint64_t>::disc_tests, problem_.discs.size() * (last - first));
  }

  [[nodiscard]] Counts<std::uint64_t> counts() const override { return tally_.counts(); }

 private:
  const Problem& problem_;
  StopCheck check_;
  Tally<counting> tally_;
};

template <bool counting>
void search(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  search_rays(
      problem, options, [&] { return std::make_unique<BruteForceSearch<counting>>(problem, options.stop); }, outcome);
}

void search(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  options.count ? search<true>(problem, options, outcome) : search<false>(problem, options, outcome);
}

}  // namespace

void run_brute_force(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  Stopwatch watch;
  if (!options.plain && stream::can_search(problem)) {
    stream::search_all(problem, options, outcome);
  } else {
    need_memory("their sums", found_bytes(problem, options), problem, outcome);
    search(problem, options, outcome);
  }
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim
