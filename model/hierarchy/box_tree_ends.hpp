#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "detp/model/vocabulary/workload.hpp"

/// Where the mean box around discs ends.
namespace detp::model::box_tree {

/// How far, on average, a box around m isotropic discs ends before the farthest point that a disc can reach.
///
/// Along an axis where the samples' coordinates x are uniform in [0, L], the box ends at L + d - y. Here y is the
/// smallest of m values (L - x) + (d - reach), where d is the largest radius. A disc of radius r extends along the axis
/// from its centre by reach = r √(1 - u²), with u uniform in [0, 1]. So
///
///     E[y] = ∫₀^{L+d} (1 - G(y))^m dy      G(y) = (1/L) ∫ P(d - reach < v) dv, over v from y - L (or 0) to y
///
///   where  P(d - reach < v)   √(1 - ((d - v)/r)²) for d - r < v < d, 1 beyond; its mean over classes of radii
///          L = 0              samples on a face of the cube: G(y) = P(d - reach < y)
///
/// Equal radii share one table. Classes of radii have their own, with a row for each L that is asked for.
///
/// Source     our derivation.
/// Accuracy   E[y], interpolated, 0.2 % for equal radii. Sides of boxes around discs of mixed radii: 2 %
///            (tests/model/hierarchy/box_tree_ends.test.cpp).
class BoxEnds {
 public:
  /// E[y] for one L and all m.
  class Row {
   public:
    /// m >= 1, not necessarily a whole number.
    [[nodiscard]] double missing(double discs) const;
    /// For m = 1 … out.size(), at most most_exact.
    void missing_up_to(std::span<double> out) const;

   private:
    friend class BoxEnds;
    static constexpr std::size_t next_row = 64 + 4 * 16;

    const double* entries_ = nullptr;
    double weight_ = 0;  ///< weight of the next row
    double scale_ = 0;   ///< L + d
    double single_ = 0;  ///< E[y] of one disc
  };

  static constexpr std::size_t most_exact = 64;

  /// All discs have this radius. Not explicit: a radius is used in place of ends.
  BoxEnds(double radius);
  /// Radii in the unit of length of the sides.
  explicit BoxEnds(std::vector<RadiusClass> classes);
  ~BoxEnds();

  /// For discs uniform along a side L >= 0. The row is valid as long as these ends.
  [[nodiscard]] Row row(double side) const;

  [[nodiscard]] double largest_radius() const { return largest_; }
  [[nodiscard]] double rms_radius() const { return rms_; }
  /// Variance of one disc's extent 2 reach along an axis.
  [[nodiscard]] double extent_variance() const { return extent_variance_; }

 private:
  class Table;
  class MixedTable;

  double largest_;
  double log_largest_;
  double rms_;
  double mean_;
  double extent_variance_;
  std::unique_ptr<MixedTable> mixed_;  ///< null if all radii are equal
};

}  // namespace detp::model::box_tree
