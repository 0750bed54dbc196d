#pragma once

#include <array>

#include "detp/model/vocabulary/parameters.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "index_overlap.hpp"

namespace detp::model {

/// The cells of an index, and the numbers that follow from their side.
struct Cells {
  double side = 0;                       ///< a, length
  std::array<double, 3> along{1, 1, 1};  ///< cells along each axis
  Insertion insertion = Insertion::exact;
  /// E: expected number of cells that a disc overlaps. No disc crosses the outermost planes of the index
  double overlapped = 1;
  /// S (faces_seen): a convex body of surface area S a² is met by as many lines as meet at least one of the cells that
  /// a disc overlaps (S = 6 for one cell)
  double seen = 6;
  double crossing = 0;  ///< P(cell), for all rays of the workload
  double meeting = 0;   ///< P(at least one of the cells that a disc overlaps), for all rays

  [[nodiscard]] double count() const { return along[0] * along[1] * along[2]; }
};

/// `parts` cells along the longest side of the box grown by d, and as many as needed along the others.
///
/// E and S are computed from the planes that cross a disc (`PlaneCrossings`, index_overlap.hpp).
/// Samples of dimension 2 without an extent of their own lie on the box's faces, in proportion to the faces' areas,
/// with one coordinate fixed. For dimensions between 2 and 3, volume and faces are interpolated.
///
/// Valid      P: cells inside S₀. The corners of a cube of samples, grown by d, extend outside S₀. P of the grown cube
///            is then 0.1 % too large if d is 1/20 of the samples' side, 0.5 % at 1/10, 2 % at 1/5, 11 % at 1/2.
/// Accuracy   counted in a cube and on its faces, n_P 1e3 … 1e5, d/a 0.05 … 4, 1 to 8 halvings, d <= side/5 (150
///            cases): E within 2.2 % (median 0.3 %), by bounding box 2.9 % (0.3 %); the noise of 1000 samples is 2 %.
///            With d up to side/4, E within 2.1 % (n_P 1e4, 1e5). With larger discs,
///            E is up to 6 % too small, and disc tests with mailboxes up to 13 % too many.
[[nodiscard]] Cells index_cells(const Valid<Workload>& workload, double parts, Insertion insertion = Insertion::exact);

/// Expected number of cells that hold at least one disc:
///
///     Σ_cells 1 - (1 - q)^n_P
///
///   where  q   probability that a disc overlaps the cell, the cell's part of E. Along each axis, either the disc's
///              centre lies in the cell's slab, or the disc reaches into the slab. q is smaller at the index's ends
///
/// Accuracy   counted as for E: within 2.7 % (median 0.2 %); with d > side/4 up to 13 % too few.
///
/// If the samples lie on surfaces with an extent A of their own, the result is R (1 - exp(-n_P E/R)), as if all R cells
/// that a random surface crosses were equally likely. R = min(C, 1.5 A/a²), where C is the number of all cells. This is
/// only an estimate.
[[nodiscard]] double occupied_cells(const Valid<Workload>& workload, const Cells& cells);

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
