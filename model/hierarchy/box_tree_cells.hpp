#pragma once

#include <array>
#include <cstdint>
#include <vector>

/// The cells that the tree of boxes is made of.
///
/// The builder (sim/lists/simd/disc_tree.hpp) splits the discs where the Lebesgue curve leaves a cell: first the cube
/// of the samples across x, then its halves across y, then z, x, … Lengths here are multiples of the cube's side.
namespace detp::model::box_tree {

/// Cells that are alike: in size, and in how they touch the samples' surface.
struct CellKind {
  double cells = 0;                      ///< number of such cells
  double share = 0;                      ///< of all samples that one such cell expects
  std::array<double, 3> side{};          ///< 0 across a face of the cube, if all samples in the cell lie on it
  std::array<int, 3> touched{};          ///< D = 2: faces of the cube, across each axis, that pass through the cell
  int halvings = 0;                      ///< of the volume, or of a face's part; of cells with edges, of a like cell
  std::array<std::uint16_t, 2> child{};  ///< kinds of its halves; 0: is not split further
  std::array<double, 2> part{};          ///< of its samples that each half expects
};

/// All kinds for samples uniform in a cube (3) or on its faces (2), each before its halves; the whole cube is the
/// first.
[[nodiscard]] const std::vector<CellKind>& cell_kinds(int dimension);

}  // namespace detp::model::box_tree
