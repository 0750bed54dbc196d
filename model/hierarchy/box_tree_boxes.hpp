#pragma once

#include <array>

#include "box_tree_cells.hpp"

namespace detp::model::box_tree {

/// Means over boxes.
struct MeanBox {
  double products = 0;  ///< xy + yz + zx of the sides, half the surface
  double surface = 0;   ///< of the convex body whose lines the cull lists, F + 2 ln(4/3)/π (x² + y² + z²)
  double volume = 0;
};

/// The mean box around m discs in a cell, all turned isotropically.
///
/// Along an axis where the samples are uniform in [0, L], the box ends before L + d by y, the least of m differences
/// (L - x) + (d - reach), with reach = d √(1 - u²), u uniform in [0, 1]:
///
///     E[y] = ∫₀^{L+d} (1 - G(y))^m dy      G(y) = (1/L) ∫ P(d - reach < v) dv, over v from y - L (or 0) to y
///
///   where  P(d - reach < v)   √(1 - (1 - v/d)²) for v < d, beyond 1; L = 0, samples on a face of the cube: G itself
///
/// and the sides of the box are L + 2d less both ends' E[y]. Sides along different axes are taken as independent, and
/// products of means for means of products: exact for d = 0, where E[side] = L (m - 1)/(m + 1).
///
/// Source     our derivation.
/// Accuracy   E[y], interpolated, 0.2 %.
class CellBoxes {
 public:
  CellBoxes(const CellKind& cell, double disc_radius);

  /// m >= 1, any number.
  [[nodiscard]] MeanBox operator()(double discs) const;

 private:
  /// E[y] of one L and d: between two rows of a table.
  struct Row {
    const double* entries = nullptr;
    double weight = 0;  ///< of the next row
    double scale = 0;   ///< L + d
    double single = 0;  ///< E[y] of one disc
  };

  struct Axis {
    double length = 0;
    Row uniform;         ///< along it
    int touched = 0;     ///< CellKind
    double on_face = 0;  ///< share of the discs that lies on each face across it
    double uniform_share = 1;
    double log_off_face = 0;  ///< logarithms of shares: of discs off that face,
    double log_on_faces = 0;  ///< on either
  };

  static Row row_of(double side, double radius, double log_radius);
  static double missing(const Row& row, double discs);
  [[nodiscard]] double side_of(const Axis& axis, double discs) const;

  double radius_;
  Row flat_;  ///< L = 0
  std::array<Axis, 3> axes_;
};

}  // namespace detp::model::box_tree
