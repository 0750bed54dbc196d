#include "cell_walk.hpp"
#include "detp/sim/stream/search.hpp"
#include "detp/sim/stream/walk_search.hpp"
#include "list_memory.hpp"
#include "techniques.hpp"
#include "walk_search.hpp"

namespace detp::sim {

void run_cell_spheres(const Problem& problem, const CellSpheresParameters& parameters, const RunOptions& options,
                      Outcome& outcome) {
  const bool plain = options.plain || !stream::can_search(problem);
  need_memory("lists of rays inside one another", walk_bytes(problem, options, lists_of(problem, parameters), plain),
              problem, outcome);
  Stopwatch watch;
  std::vector<std::uint32_t> order = along_curve(problem.discs, SampleOrder::lebesgue, options.stop);
  outcome.seconds.order = watch.lap();
  const std::size_t sorted = order.size();
  if (!plain) {
    const auto make_walk = [&] { return std::make_unique<CellWalk>(problem.discs, parameters.depth); };
    stream::search_walk(problem, std::move(order), make_walk, lists_of(problem, parameters).room(), options, outcome);
  } else {
    CellWalk walk(problem.discs, parameters.depth);
    search_along(walk, problem, order, options, outcome);
  }
  if (options.count) outcome.counts.sorted = sorted;
  outcome.seconds.search = watch.lap();
}

}  // namespace detp::sim
