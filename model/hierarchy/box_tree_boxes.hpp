#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "box_tree_ends.hpp"
#include "detp/model/vocabulary/engine.hpp"

namespace detp::model::box_tree {

// The cells from which the box tree is made.
//
// The builder (sim/lists/simd/disc_tree.hpp) splits the discs where the Morton curve (the paper: Lebesgue curve)
// goes from one half of a cell to the other. The cube of the samples is halved across x, its halves across y, then
// z, x, … The smallest cells of the curve have 1/1024 of the cube's side, or 1/64 if there are fewer than 8192
// samples. The builder splits the discs of such a cell in the middle of an arbitrary order. This model splits them at
// random: both halves have the sides of the cell. Lengths here are multiples of the cube's side.

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

/// How an engine lists rays for a box: it grows the box on all sides by `margin`, in units of the cube's side.
struct Listing {
  Engine engine = Engine::simd;
  double margin = 0;
};

/// The simd engine lists as many lines as cross a convex body whose half surface is larger than that of the box by
/// this times the sum of the squared sides (validate/structural).
inline constexpr double listed_beyond = 0.28768207245178093 / std::numbers::pi;  // ln(4/3)/π

/// Means over boxes.
struct MeanBox {
  double products = 0;  ///< xy + yz + zx of the sides, half the surface
  double spread = 0;    ///< variance of the products over their squared mean
  double surface = 0;   ///< of a convex body: the cull lists the lines that cross it
  double volume = 0;
};

/// The mean box around m isotropic discs in a cell.
///
/// The sides of the box are L + 2d minus E[y] at both ends (box_tree_ends.hpp). Sides along different axes count as independent, so the
/// mean of a product is the product of the means. This is exact for d = 0, where E[side] = L (m - 1)/(m + 1).
///
/// The plain engine lists the lines that cross the box, of surface F = 2 (xy + yz + zx). The simd engine lists as many
/// lines as cross a convex body of surface F + 2 ln(4/3)/π (x² + y² + z²) (validate/structural).
///
/// Source     our derivation.
class CellBoxes {
 public:
  /// The boxes are valid as long as the ends.
  CellBoxes(const CellKind& cell, const BoxEnds& ends, const Listing& listing = {});

  /// m >= 1, not necessarily a whole number.
  [[nodiscard]] MeanBox operator()(double discs) const;

  /// MeanBox::products for m = 1 … products.size(), at most 64, in a cell that no face of the cube passes through, or
  /// whose samples all lie on one face.
  void products(std::span<double> products) const;

 private:
  using Row = BoxEnds::Row;

  struct Axis {
    double length = 0;
    Row uniform;               ///< for discs uniform along the axis
    int touched = 0;           ///< as in CellKind
    double on_face = 0;        ///< share of the discs on one of the touched faces across the axis
    double uniform_share = 1;  ///< share of the discs on no face across the axis
    double log_off_face = 0;   ///< logarithm of 1 - on_face
    double log_on_faces = 0;   ///< logarithm of the share of the discs on any face across the axis
  };

  [[nodiscard]] double side_of(const Axis& axis, double discs) const;
  [[nodiscard]] double variance_of(const Axis& axis, double discs) const;

  double radius_;           ///< the largest
  double extent_variance_;  ///< BoxEnds::extent_variance
  Listing listing_;
  Row flat_;  ///< L = 0
  std::array<Axis, 3> axes_;
};

}  // namespace detp::model::box_tree
