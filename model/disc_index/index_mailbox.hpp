#pragma once

#include "detp/model/vocabulary/index_variant.hpp"

namespace detp::model {

/// Lines that meet at least one of the cells that a disc overlaps, divided by those that meet a square with a cell's
/// side: S. (The lines that meet a convex body are proportional to its surface area: S = 6 for one cell.)
///
///     exact          S = 6 + R(x) N/(3π/2) + 4 M/3
///     bounding box   S = 6 + 4 N + 2 M
///
///   where  x   disc radius over cell side
///          N   expected planes that cross the disc: (3π/2) x in endless cells
///          M   expected lines, where two planes meet: (3π/2) x² in endless cells (boxes: 12 · 0.5932 x²)
///          R   tabulated from 1/16 to 32, 18.2 … 19.5;   R(0) = 6π;   constant beyond 32
///
/// So n_R n_P S a²/(4π r₀²) discs are tested with mailboxes; without them S is replaced by 6 E.
///
/// Source     our derivation. A box of 1 + N_i cells along the axes is convex, F = 2 Σ (1 + N_i)(1 + N_j). For x → 0 a
///            disc overlaps one cell, or two, F = 10, with the probability (3π/2) x: R(0) = 4 · 3π/2. For x → ∞ the
///            cells tend to the disc itself, F = 2πx²: hits per test → 1 with mailboxes, (2π x²)/(6 · (3π/2) x²) = 2/9
///            without. R: validate/tools/mailbox_table.cpp.
/// Throws     std::invalid_argument unless x, N and M are >= 0 and finite.
[[nodiscard]] double faces_seen(double x, double planes, double lines, Insertion insertion);

}  // namespace detp::model
