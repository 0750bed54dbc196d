#pragma once

#include "vocabulary.hpp"
#include "vocabulary/index_variant.hpp"

/// The size of an index that takes the least time, in place of the paper's, whose cells are as wide as a disc (eq 21).
namespace detp::model {

/// Depth of the fastest octree, searched top-down, from 0 to `most_depth`: all of them tried, each level predicted
/// once. Throws std::invalid_argument for a workload or depth out of range.
[[nodiscard]] int best_octree_depth(const Workload& workload, const UnitCosts& costs, const IndexVariant& variant = {},
                                    int most_depth = 20);

/// Cells along the longest side of the fastest grid, from 1 to `most_cells`.
///
/// With m cells a side a cube takes, by n_R P(cube) lines, u n_P E/m² + v m per line and b n_P E to build, E a
/// polynomial in m with positive factors: every term is convex in m, so there is one minimum, found by golden section
/// over log m. Where the box ends, and most where it is no cube and the last cells stick out, the time ripples around
/// that: so up to 128 numbers within a factor of 1.6 of it are tried, and then the neighbours of the best.
/// Accuracy   of 20 cubes and 20 flat boxes, up to 600 cells a side: within 0.1 % and 1 % of the least time of all.
/// Throws     std::invalid_argument for a workload or a number out of range.
[[nodiscard]] int best_grid_cells(const Workload& workload, const UnitCosts& costs, const IndexVariant& variant = {},
                                  int most_cells = 1 << 20);

}  // namespace detp::model
