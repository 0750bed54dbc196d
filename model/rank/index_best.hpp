#pragma once

#include <optional>

#include "registry.hpp"

/// The size of an index with the smallest time; the paper's cells are as wide as a disc (eq 21) instead. Nothing if
/// every size exceeds the limits. Throws std::invalid_argument for a workload out of range.
namespace detp::model {

/// Depth of the fastest octree, searched top-down: all depths tried, each level predicted once.
[[nodiscard]] std::optional<int> best_octree_depth(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                                   const SearchLimits& limits = {});

/// Cells along the longest side of the fastest grid, from 1 to 65 536.
///
/// With m cells a side a cube takes, by n_R P(cube) lines, u n_P E/m² + v m per line and b n_P E to build, E a
/// polynomial in m with positive factors: every term is convex in m, so there is one minimum. Where the box ends, and
/// most where it is no cube and the last cells stick out, the time ripples around that. So m is tried in steps of 10 %
/// until it takes three times the least, then up to 64 numbers within a factor of 1.4 of the best, then its neighbours.
/// Accuracy   of 1200 cubes and boxes, some a thousandth as high as long: the least time that any of seven searches
///            found on 95 %, 7.7 % more at worst; never more than in steps of 10 %.
[[nodiscard]] std::optional<int> best_grid_cells(const Valid<Workload>& workload, const Valid<UnitCosts>& costs,
                                                 const SearchLimits& limits = {});

}  // namespace detp::model
