#pragma once

#include "detp/sim/lists/list_walk.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/problem.hpp"
#include "ray_list.hpp"

namespace detp::sim {

/// Adds the spheres' counts to `counts`.
inline void add_spheres(std::span<const SphereCounts> spheres, Counts<std::uint64_t>& counts) {
  for (const SphereCounts& sphere : spheres) {
    counts.cull_tests += sphere.tests;
    counts.listed += sphere.listed;
    counts.culls += sphere.rebuilds;
  }
}

/// The plain engine of all techniques whose spheres follow the discs. For each disc, in `order`, rebuilds the levels
/// that the walk returns, and tests the disc against the innermost list.
template <bool counting>
void search_along_counting(ListWalk& walk, const Problem& problem, std::span<const std::uint32_t> order,
                           const RunOptions& options, Outcome& outcome) {
  HitCollector collector(problem, options, outcome);
  Tally<counting> tally;
  StopCheck check(options.stop, "searching");
  std::pmr::vector<RayList> lists(static_cast<std::size_t>(walk.deepest()) + 1, options.memory);
  std::vector<SphereCounts>& events = outcome.spheres;
  if constexpr (counting) events.assign(lists.size() - 1, {});
  lists[0] = list_of(problem.rays(), options.memory);
  collector.save_totals();
  std::size_t done = 0;
  const auto process_disc = [&](std::uint32_t d) {
    const Disc disc = problem.discs()[d];
    for (int level = walk.enter(disc); level <= walk.innermost(); ++level) {
      const auto i = static_cast<std::size_t>(level);
      check.after(1);
      cull(lists[i - 1], walk.sphere(level), problem.slack(), lists[i], check);
      if constexpr (counting) {
        ++events[i - 1].rebuilds;
        events[i - 1].tests += lists[i - 1].size();
        events[i - 1].listed += lists[i].size();
      }
    }
    check.after(1);
    tally.add(&Counts<std::uint64_t>::visits);
    test_disc(lists[static_cast<std::size_t>(walk.innermost())], disc, d, collector, tally, check);
  };
  try {
    for (; done < order.size(); ++done) process_disc(order[done]);
  } catch (const Stopped&) {  // the unfinished disc is left out
  }
  outcome.counts = tally.counts();
  if constexpr (counting) {
    add_spheres(events, outcome.counts);
  }
  if (done < order.size())
    collector.store_partial_results(order.first(done));
  else
    collector.store_results(problem.rays().size());
}

inline void search_along(ListWalk& walk, const Problem& problem, std::span<const std::uint32_t> order,
                         const RunOptions& options, Outcome& outcome) {
  options.count ? search_along_counting<true>(walk, problem, order, options, outcome)
                : search_along_counting<false>(walk, problem, order, options, outcome);
}

}  // namespace detp::sim
