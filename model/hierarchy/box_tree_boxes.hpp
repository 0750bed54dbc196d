#pragma once

#include <array>
#include <numbers>
#include <span>

#include "box_tree_cells.hpp"
#include "box_tree_ends.hpp"
#include "detp/model/vocabulary/engine.hpp"

namespace detp::model::box_tree {

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
