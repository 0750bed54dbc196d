#pragma once

#include <array>
#include <cstdint>
#include <vector>

/// The cells from which the box tree is made.
///
/// The builder (sim/lists/simd/disc_tree.hpp) splits the discs where the Morton curve (the paper: Lebesgue curve)
/// goes from one half of a cell to the other. The cube of the samples is halved across x, its halves across y, then
/// z, x, … The smallest cells of the curve have 1/1024 of the cube's side, or 1/64 if there are fewer than 8192
/// samples. The builder splits the discs of such a cell in the middle of an arbitrary order. This model splits them at
/// random: both halves have the sides of the cell. Lengths here are multiples of the cube's side.
namespace detp::model::box_tree {

/// A kind of cells that have the same size and touch the samples' surface in the same way.
struct CellKind {
  double cells = 0;              ///< number of such cells
  double share = 0;              ///< expected share of all samples in one cell
  std::array<double, 3> side{};  ///< 0 across a face of the cube if all samples in the cell lie on that face
  std::array<int, 3> touched{};  ///< D = 2: number of faces of the cube, across each axis, that pass through the cell
  bool last = false;             ///< a smallest cell of the curve, or a part of its discs
  /// number of halvings of the cube (D = 3) or of a face (D = 2); at edges and corners, that of a cell of equal size
  int halvings = 0;
  std::array<std::uint16_t, 2> child{};  ///< kinds of its halves; 0: not split further
  std::array<double, 2> part{};          ///< expected share of its samples in each half
};

/// All kinds of cells for samples uniform in a cube (dimension 3) or on its faces (2). Each kind comes before the kinds
/// of its halves; the first kind is the whole cube.
[[nodiscard]] const std::vector<CellKind>& cell_kinds(int dimension, double samples);

}  // namespace detp::model::box_tree
