#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Index of discs (octree) as in the paper: cells as wide as a disc, each disc in one cell.
///
/// The paper uses a scene of side 2; here its side s is explicit. disc_index.hpp has the corrected formulas.
///
/// Valid      any positive doubles d and s; depths 0 … 2096, the largest depth for any two doubles.
/// Limits     results above the largest double saturate; below the smallest normal double the error is at most one
///            spacing of doubles.
/// Accuracy   1.1e-16 compared with 100 digits, over 10⁶ inputs log-uniform over that domain (tests/model/hard_cases).
/// Throws     std::invalid_argument for numbers out of range.
namespace detp::model::published {

/// k = ⌊log₂(s/(2d))⌋, the largest depth at which a cell is at least as wide as a disc; at least 0 (eqs 20, 21). The
/// result has no rounding error. It was right for all of 3.6·10⁶ inputs, most of them with s/d within an ulp of a power
/// of two.
[[nodiscard]] int octree_depth(DiscRadius disc, double side);

/// 2^k: cells crossed by a line (section 4.2). This is exactly the mean over lines that hit the cube.
[[nodiscard]] double cells_per_line(int depth);

/// n_P/8^k: discs in a cell, if each disc lay in only one.
[[nodiscard]] double discs_per_cell(double samples, int depth);

/// n_P/4^k: ray-disc tests of a line.
[[nodiscard]] double tests_per_line(double samples, int depth);

/// T = u k n_R n_P/4^k (eq 22): multiplies the disc tests, not the steps, by the depth.
[[nodiscard]] double octree_time(const Valid<Workload>& workload, int depth, double disc_test);

/// T = u n_R n_P/4^k: if a cell's neighbour is found in O(1) (balanced tree).
[[nodiscard]] double balanced_octree_time(const Valid<Workload>& workload, int depth, double disc_test);

}  // namespace detp::model::published
