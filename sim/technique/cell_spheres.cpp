#include "detp/sim/lists/cell_walk.hpp"
#include "technique.hpp"
#include "walk_index.hpp"

namespace detp::sim {

/// Spheres around the cells of an octree (CellWalk). The discs are visited along the Morton curve, so each cell's list
/// of rays is made only once, from the list of the parent cell. A disc is tested against the innermost list.
std::unique_ptr<Index> prepare_cell_spheres(const Problem& problem, const Parameters& parameters,
                                            const RunOptions& options) {
  const auto& own = std::get<CellSpheresParameters>(parameters);
  const CellWalk walk(problem.discs(), own.depth);
  return prepare_walk(
      problem,
      {.make_walk =
           [walk](std::pmr::memory_resource& memory) { return make_in<ListWalk, CellWalk>(memory, walk, memory); },
       .lists = lists_of(problem, own),
       .what = "lists of rays inside one another"},
      options);
}

}  // namespace detp::sim
