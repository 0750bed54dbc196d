#include "cell_walk.hpp"
#include "ray_list.hpp"
#include "techniques.hpp"

namespace detp::sim {
namespace {

template <bool counting>
void search(const Problem& problem, int depth, const RunOptions& options, Outcome& outcome) {
  Stopwatch watch;
  const std::vector<std::uint32_t> order = along_curve(problem.discs);
  outcome.seconds.order = watch.lap();
  HitCollector collector(problem, options);
  Tally<counting> tally;
  CellWalk walk(problem.discs, depth);
  std::vector<RayList> lists(static_cast<std::size_t>(depth) + 1);
  lists[0] = list_of(problem.rays);
  for (const std::uint32_t d : order) {
    const Disc disc = problem.discs[d];
    for (int level = std::max(1, walk.enter(disc)); level <= depth; ++level) {
      const RayList& around = lists[static_cast<std::size_t>(level) - 1];
      RayList& inside = lists[static_cast<std::size_t>(level)];
      cull(around, walk.sphere(level), problem.slack, inside);
      tally.add(&Counts<std::uint64_t>::rebuilds);
      tally.add(&Counts<std::uint64_t>::sphere_tests, around.size());
      tally.add(&Counts<std::uint64_t>::copies, inside.size());
    }
    test_disc(lists.back(), disc, d, collector, tally);
    outcome.stopped = options.stop.stop_requested();
    if (outcome.stopped) break;
  }
  tally.add(&Counts<std::uint64_t>::sorted, order.size());
  outcome.counts = tally.counts();
  std::move(collector).give(outcome);
  outcome.seconds.search = watch.lap();
}

}  // namespace

void run_cell_spheres(const Problem& problem, const CellSpheresParameters& parameters, const RunOptions& options,
                      Outcome& outcome) {
  options.count ? search<true>(problem, parameters.depth, options, outcome)
                : search<false>(problem, parameters.depth, options, outcome);
}

}  // namespace detp::sim
