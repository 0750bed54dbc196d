#pragma once

#include "detp/model/vocabulary/index_variant.hpp"

namespace detp::model {

/// S: a convex body of surface area S a², where a is the cell's side, is met by as many lines as meet at least one of
/// the cells that a disc overlaps. S = 6 for one cell.
///
///     exact          S = 6 + R(x) N/(3π/2) + 4 M/3
///     bounding box   S = 6 + 4 N + 2 M
///
///   where  x   disc radius over cell side
///          N   expected number of planes that cross the disc: (3π/2) x in endless cells
///          M   expected number of lines that pierce the disc, each the intersection of two planes: (3π/2) x² in
///              endless cells (boxes: 12 · 0.5932 x²)
///          R   tabulated for x from 1/16 to 32, 18.2 … 19.5;   R(0) = 6π;   constant beyond 32
///
/// So n_R n_P S a²/(4π r₀²) disc tests are made with mailboxes; without mailboxes 6 E replaces S.
///
/// Source     our derivation, with surface areas F over a². A box of 1 + N_i cells along the axes is convex,
///            F = 2 Σ (1 + N_i)(1 + N_j). For x → 0 a disc overlaps two cells (F = 10) with the probability (3π/2) x,
///            else one: R(0) = 4 · 3π/2. For x → ∞ the cells tend to the disc itself, F = 2πx². So the hits per test
///            tend to 1 with mailboxes, and to (2π x²)/(6 · (3π/2) x²) = 2/9 without. R:
///            validate/tools/mailbox_table.cpp.
/// Throws     std::invalid_argument unless x, N and M are >= 0 and finite.
[[nodiscard]] double faces_seen(double x, double planes, double lines, Insertion insertion);

}  // namespace detp::model
