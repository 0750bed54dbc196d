#include "disc_index.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "index_cells.hpp"

namespace detp::model {
namespace {

Counts<double> leaf_counts(const Valid<Workload>& workload, const Cells& cells, const IndexVariant& variant) {
  const double references = workload.samples * cells.overlapped;
  const double once = workload.samples * cells.meeting;
  return {.disc_tests = workload.rays * (variant.mailboxing ? once : cells.crossing * references),
          .references = references,
          .hits = expected_hits(workload)};
}

/// Expected number of grid cells that a ray steps through, from the mean surface and volume of the cells' parts inside
/// the discs' box.
double steps_of_ray(const Valid<Workload>& workload, const Cells& cells) {
  std::array<double, 3> length = workload.box;
  for (double& side : length)
    side += 2 * std::min(largest_radius(workload), 1e99);  // so that the volume does not overflow
  double faces = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    faces += 2 * cells.along[axis] * length[(axis + 1) % 3] * length[(axis + 2) % 3];
  const double count = cells.count();
  return count * crossing_probability(workload, length[0] * length[1] * length[2] / count, faces / count);
}

}  // namespace

void for_each_octree_depth(const Valid<Workload>& workload, const OctreeParameters& deepest,
                           const IndexVariant& variant, const std::function<bool(const Counts<double>&)>& visit) {
  require_count("depth", deepest.depth, 0, 300);
  if (deepest.traversal == Traversal::neighbour_links)
    throw std::invalid_argument("an octree with neighbour links has no closed form; the other traversals have");
  double above = 0;       // nodes visited by a ray above this level
  double left_out = 0;    // visits on the way to omitted octants, down to this level
  double placements = 0;  // down to this level
  double parents = 0;     // occupied nodes one level up
  for (int level = 0; level <= deepest.depth; ++level) {
    const Cells nodes = index_cells(workload, std::ldexp(1.0, level), variant.insertion);
    const double occupied = occupied_cells(workload, nodes);
    if (level > 0) {
      placements += workload.samples * nodes.overlapped;
      left_out += level * nodes.crossing * std::max(0.0, 8 * parents - occupied);
    }
    Counts<double> counts = leaf_counts(workload, nodes, variant);
    const double leaves = nodes.crossing * occupied;
    const bool restart = deepest.traversal == Traversal::restart;
    counts.nodes = workload.rays * (restart ? left_out + (level + 1) * leaves : above + leaves);
    counts.placements = placements;
    if (!visit(counts)) return;
    above += leaves;
    parents = occupied;
  }
}

std::vector<Counts<double>> octree_counts_by_depth(const Valid<Workload>& workload, const OctreeParameters& deepest,
                                                   const IndexVariant& variant) {
  std::vector<Counts<double>> by_depth;
  for_each_octree_depth(workload, deepest, variant, [&](const Counts<double>& counts) {
    by_depth.push_back(counts);
    return true;
  });
  return by_depth;
}

Counts<double> octree_counts(const Valid<Workload>& workload, const OctreeParameters& parameters,
                             const IndexVariant& variant) {
  return octree_counts_by_depth(workload, parameters, variant).back();
}

Counts<double> grid_counts(const Valid<Workload>& workload, const GridParameters& parameters,
                           const IndexVariant& variant) {
  require_count("cells a side", parameters.cells, 1, 1e9);
  const Cells cells = index_cells(workload, parameters.cells, variant.insertion);
  Counts<double> counts = leaf_counts(workload, cells, variant);
  counts.steps = workload.rays * steps_of_ray(workload, cells);
  counts.placements = counts.references;
  return counts;
}

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
