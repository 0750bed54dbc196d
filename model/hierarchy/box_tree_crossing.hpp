#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detp/model/lines/line_measure.hpp"

namespace detp::model::box_tree {

/// A cube of samples, or its faces, for the trees of box_tree_expected.hpp, whose unit of length is its side.
class SampleCube {
 public:
  explicit SampleCube(const Valid<Workload>& workload) {
    const double dimension = std::clamp(workload.dimension, 2.0, 3.0);
    side_ = std::pow(sample_extent(workload) / std::pow(6, 3 - dimension), 1 / dimension);
    constexpr double far = 1e60;  // a larger or smaller radius makes no difference
    radius_ = std::clamp(workload.disc_radius / side_, 1 / far, far);
    // The margin is 64 · 2⁻²⁴ in units of the frame (sim/lists/simd/frame.hpp). The frame scales r₀ to [½, 1) by a power
    // of two. Here r₀ is scaled to √3/2, as in a cube of side 1, so that the unit of length does not matter.
    margin_ = 0x1p-18 * workload.sphere_radius / (std::numbers::sqrt3 / 2) / side_;
    of_surface_ = crossing_probability(workload, 0, std::min(largest, unit * side_ * side_)) / unit;
    of_volume_ = crossing_probability(workload, std::min(largest, unit * side_ * side_ * side_), 0) / unit;
  }

  [[nodiscard]] double radius() const { return radius_; }  ///< d
  [[nodiscard]] double margin() const { return margin_; }  ///< as in Listing

  /// P(node) from the mean surface and volume of nodes' boxes.
  [[nodiscard]] double crossing(double surface, double volume) const {
    return std::min(1.0, of_surface_ * surface + of_volume_ * volume);
  }

 private:
  static constexpr double unit = 0x1p-40;  // so small that every probability is below 1
  static constexpr double largest = 1e300;

  double side_;  ///< length
  double radius_;
  double margin_;
  double of_surface_;
  double of_volume_;
};

}  // namespace detp::model::box_tree
