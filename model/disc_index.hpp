#pragma once

#include <array>

#include "vocabulary.hpp"

/// Index of discs, corrected: cubic cells, each with a reference to every disc that overlaps it.
///
/// The cells fill the samples' box grown by d on all sides, so that no disc pokes out. A ray enters cells from outside,
/// tests all discs referenced there, and may meet a disc in several cells. The expected number of bodies that random
/// lines meet is a sum of surface areas, so for any structure
///
///     tests = n_R Σ_cells P(cell) references(cell) = n_R P(cell) n_P E
///     steps = n_R Σ_cells P(cell)        (a tree: nodes visited, summed over all its nodes)
///
///   where  P       crossing_probability of a cell (line_measure.hpp): for lines that hit a cube cut in 2^k along each
///                  side, Σ_cells P = 2^k and P = 1/4^k
///          E       expected cells that a disc overlaps
///
/// Against the paper's eq (22): it multiplies the tests by the depth, and puts each disc in one cell (E = 1). There is
/// no factor log n_P even in a plain octree: the nodes above the leaves add as many steps again as there are leaves.
namespace detp::model {

/// Cells that a uniformly placed, isotropically turned disc overlaps, in endless cubic cells:
///
///     E = 1 + (3π/2) x + (3π/2) x²      x = d/a
///
/// Source     our derivation: the planes of the grid that the disc crosses, and the lines where two of them meet.
/// Throws     std::invalid_argument unless x >= 0 and finite.
[[nodiscard]] double overlapped_cells(double x);

/// The cells of an index, and what follows from their side.
struct Cells {
  double side = 0;                       ///< a, length
  std::array<double, 3> along{1, 1, 1};  ///< cells along each axis
  double overlapped = 1;                 ///< E, in a box that ends: its outermost planes are never crossed
  double crossing = 0;                   ///< P(cell), of all rays of the workload

  [[nodiscard]] double count() const { return along[0] * along[1] * along[2]; }
};

/// `parts` cells along the longest side of the box grown by d; as many as it takes along the others.
/// Samples of dimension 2 without an extent of their own lie on the box's faces, one coordinate fixed: there the planes
/// of the grid are at known distances from them.
[[nodiscard]] Cells index_cells(const Workload& workload, double parts);

/// Cells that hold at least one disc, if the discs lie anew at random: C (1 - exp(-n_P E/C)), C the cells within reach
/// of the samples' body: all of them (D = 3), at most 1.5 A/a² (D = 2: a random surface crosses that many).
[[nodiscard]] double occupied_cells(const Workload& workload, const Cells& cells);

/// Expected counts of an octree whose leaves all lie at one depth, empty nodes left out.
[[nodiscard]] Counts<double> octree_counts(const Workload& workload, const OctreeParameters& parameters);

/// Expected counts of a uniform grid; empty cells are stepped through too.
[[nodiscard]] Counts<double> grid_counts(const Workload& workload, const GridParameters& parameters);

}  // namespace detp::model
