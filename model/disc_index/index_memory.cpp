#include "index_memory.hpp"

#include <cmath>

#include "index_cells.hpp"

namespace detp::model {
namespace {

void check_layout(const IndexLayout& layout) {
  require_non_negative("bytes of a node", layout.node);
  require_non_negative("bytes of a cell", layout.cell);
  require_non_negative("bytes of a reference", layout.reference);
}

}  // namespace

double octree_bytes(const Valid<Workload>& workload, const OctreeParameters& parameters, const IndexVariant& variant,
                    const IndexLayout& layout) {
  check_layout(layout);
  require_count("depth", parameters.depth, 0, 300);
  double nodes = 0;
  Cells cells;
  for (int level = 0; level <= parameters.depth; ++level) {
    cells = index_cells(workload, std::ldexp(1.0, level), variant.insertion);
    nodes += occupied_cells(workload, cells);
  }
  return layout.node * nodes + layout.reference * workload.samples * cells.overlapped;
}

double grid_bytes(const Valid<Workload>& workload, const GridParameters& parameters, const IndexVariant& variant,
                  const IndexLayout& layout) {
  check_layout(layout);
  require_count("cells a side", parameters.cells, 1, 1e9);
  const Cells cells = index_cells(workload, parameters.cells, variant.insertion);
  return layout.cell * (cells.count() + 1) + layout.reference * workload.samples * cells.overlapped;
}

}  // namespace detp::model
