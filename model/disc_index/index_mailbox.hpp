#pragma once

#include "detp/model/vocabulary/index_variant.hpp"

namespace detp::model {

/// Lines that meet one or more of the cells that a disc overlaps, over those that meet a square of a cell's side: S.
/// (The surface area of a convex body is what lines meet it by: 6 for one cell.)
///
///     exact          S = 6 + R(x) N/(3π/2) + 4 M/3
///     bounding box   S = 6 + 4 N + 2 M
///
///   where  x   disc radius over cell side
///          N   expected planes that cross the disc: (3π/2) x in endless cells
///          M   expected lines, where two planes meet: (3π/2) x² in endless cells (boxes: 12 · 0.5932 x²)
///          R   tabulated from 1/16 to 32, 18.2 … 19.5;   R(0) = 6π;   beyond, as at 32
///
/// So, with mailboxes, n_R n_P S a²/(4π r₀²) discs are tested; without, 6 E in place of S.
///
/// Source     our derivation. A box of 1 + N_i cells along the axes is convex, F = 2 Σ (1 + N_i)(1 + N_j). For x → 0 a
///            disc overlaps one cell, or two, F = 10, with the chance (3π/2) x: R(0) = 4 · 3π/2. For x → ∞ the cells
///            are the disc itself, F = 2πx²: hits per test → 1 with mailboxes, (2π x²)/(6 · (3π/2) x²) = 2/9 without.
///            R: validate/tools/mailbox_table.cpp.
/// Throws     std::invalid_argument unless x, N and M are >= 0 and finite.
[[nodiscard]] double faces_seen(double x, double planes, double lines, Insertion insertion);

}  // namespace detp::model
