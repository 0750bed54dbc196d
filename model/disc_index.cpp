#include "disc_index.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "line_measure.hpp"

namespace detp::model {
namespace {

constexpr double half_pi = std::numbers::pi / 2;

/// Crossings of a disc with the planes across one axis, over those in endless cells: only the inner planes count. Where
/// the centres have less than a cell to lie in, they cross planes as in endless cells; never more than there are.
double inner_planes(double cells, double side, double disc) {
  const double room = cells * side - 2 * disc;
  const double crossings = room > side ? (cells - 1) * side / room : 1;
  return std::min(crossings, (cells - 1) * side / (half_pi * disc));
}

/// The same for an axis along which all centres lie at d from the box's side: planes at a, 2a, … cross a disc that
/// reaches farther than they are from its centre, an isotropic one farther than t d with the chance √(1 - t²).
double planes_near_side(double cells, double side, double disc) {
  constexpr double many = 64;  // planes: then they cross as in endless cells
  if (disc > many * side) return 1;
  double crossings = 0;
  for (double plane = 1; plane < cells && plane * side < 2 * disc; ++plane) {
    const double t = std::max(0.0, plane * side / disc - 1);
    crossings += std::sqrt(1 - t * t);
  }
  return crossings * side / (half_pi * disc);
}

/// E from the crossings across each axis, over those in endless cells.
double cells_overlapped(double x, const std::array<double, 3>& f) {
  return 1 + half_pi * x * (f[0] + f[1] + f[2]) + half_pi * x * x * (f[0] * f[1] + f[1] * f[2] + f[2] * f[0]);
}

Counts<double> leaf_counts(const Workload& workload, const Cells& cells) {
  const double references = workload.samples * cells.overlapped;
  return {.disc_tests = workload.rays * cells.crossing * references,
          .references = references,
          .hits = expected_hits(workload)};
}

}  // namespace

double overlapped_cells(double x) {
  require_non_negative("disc radius over cell side", x);
  return 1 + 3 * half_pi * x * (1 + x);
}

Cells index_cells(const Workload& workload, double parts) {
  check(workload);
  require_positive("cells along the longest side", parts);
  const double d = workload.disc_radius;
  Cells cells{.side = (scene_side(workload) + 2 * d) / parts};
  std::array<double, 3> f{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.along[axis] = std::max(1.0, std::ceil((workload.box[axis] + 2 * d) / cells.side * (1 - 1e-12)));
    f[axis] = inner_planes(cells.along[axis], cells.side, d);
  }
  const double x = d / cells.side;
  cells.overlapped = cells_overlapped(x, f);
  if (workload.sample_extent == 0) {
    // On the box's faces, one of the three axes is fixed.
    double on_faces = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<double, 3> fixed = f;
      fixed[axis] = planes_near_side(cells.along[axis], cells.side, d);
      on_faces += cells_overlapped(x, fixed) / 3;
    }
    const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
    cells.overlapped = weight * cells.overlapped + (1 - weight) * on_faces;
  }
  cells.overlapped = std::min(cells.overlapped, cells.count());
  cells.crossing = crossing_probability(workload, std::pow(cells.side, 3), 6 * cells.side * cells.side);
  return cells;
}

double occupied_cells(const Workload& workload, const Cells& cells) {
  check(workload);
  require_positive("cell side", cells.side);
  const double on_surface =
      std::min(cells.count(), std::max(1.0, 1.5 * sample_extent(workload) / (cells.side * cells.side)));
  const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
  const double reach = std::pow(cells.count(), weight) * std::pow(on_surface, 1 - weight);
  return -reach * std::expm1(-workload.samples * cells.overlapped / reach);
}

Counts<double> octree_counts(const Workload& workload, const OctreeParameters& parameters) {
  check(workload);
  require_count("depth", parameters.depth, 0, 300);
  Counts<double> counts = leaf_counts(workload, index_cells(workload, std::ldexp(1.0, parameters.depth)));
  for (int level = 0; level <= parameters.depth; ++level) {
    const Cells nodes = index_cells(workload, std::ldexp(1.0, level));
    counts.nodes += workload.rays * nodes.crossing * occupied_cells(workload, nodes);
    if (level > 0) counts.placements += workload.samples * nodes.overlapped;
  }
  return counts;
}

Counts<double> grid_counts(const Workload& workload, const GridParameters& parameters) {
  check(workload);
  require_count("cells a side", parameters.cells, 1, 1e9);
  const Cells cells = index_cells(workload, parameters.cells);
  Counts<double> counts = leaf_counts(workload, cells);
  counts.steps = workload.rays * cells.crossing * cells.count();
  counts.placements = counts.references;
  return counts;
}

}  // namespace detp::model
