#include "hit_collector.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

template <bool counting>
void search(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  HitCollector collector(problem, options);
  Tally<counting> tally;
  const auto discs = static_cast<std::uint32_t>(problem.discs.size());
  const auto rays = static_cast<std::uint32_t>(problem.rays.size());
  for (std::uint32_t d = 0; d < discs && !outcome.stopped; ++d) {
    const Disc disc = problem.discs[d];
    for (std::uint32_t r = 0; r < rays; ++r)
      if (collector.decide(problem.rays[r], disc)) collector.keep(r, d);
    tally.add(&Counts<std::uint64_t>::disc_tests, rays);
    outcome.stopped = options.stop.stop_requested();
  }
  outcome.counts = tally.counts();
  std::move(collector).give(outcome);
}

}  // namespace

void run_brute_force(const Problem& problem, const RunOptions& options, Outcome& outcome) {
  Stopwatch watch;
  options.count ? search<true>(problem, options, outcome) : search<false>(problem, options, outcome);
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim
