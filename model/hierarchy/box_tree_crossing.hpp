#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "box_tree_ends.hpp"
#include "detp/model/lines/line_measure.hpp"

namespace detp::model::box_tree {

/// A cube of samples, or its faces, for the trees of box_tree_expected.hpp, whose unit of length is its side.
class SampleCube {
 public:
  explicit SampleCube(const Valid<Workload>& workload) : side_(side_of(workload)), ends_(ends_of(workload, side_)) {
    // The margin is 64 · 2⁻²⁴ in units of the frame (sim/lists/simd/frame.hpp). The frame scales r₀ to [½, 1) by a power
    // of two. Here r₀ is scaled to √3/2, as in a cube of side 1, so that the unit of length does not matter.
    margin_ = 0x1p-18 * workload.sphere_radius / (std::numbers::sqrt3 / 2) / side_;
    density_ = workload.ray_density;
    const double tiny = unit * density_;
    of_surface_ = crossing_probability(workload, 0, std::min(largest, unit * side_ * side_)) / tiny;
    of_volume_ = crossing_probability(workload, std::min(largest, unit * side_ * side_ * side_), 0) / tiny;
  }

  [[nodiscard]] const BoxEnds& ends() const { return ends_; }
  [[nodiscard]] double side() const { return side_; }      ///< length
  [[nodiscard]] double margin() const { return margin_; }  ///< as in Listing

  /// P(node) from the mean surface and volume of nodes' boxes.
  [[nodiscard]] double crossing(double surface, double volume) const {
    return at_density(std::min(1.0, of_surface_ * surface + of_volume_ * volume), density_);
  }

 private:
  static constexpr double unit = 0x1p-40;  // so small that every probability is below 1
  static constexpr double largest = 1e300;

  static double side_of(const Workload& workload) {
    const double dimension = std::clamp(workload.dimension, 2.0, 3.0);
    return std::pow(sample_extent(workload) / std::pow(6, 3 - dimension), 1 / dimension);
  }

  static BoxEnds ends_of(const Workload& workload, double side) {
    constexpr double far = 1e60;  // a larger or smaller radius makes no difference
    const auto scaled = [&](double radius) { return std::clamp(radius / side, 1 / far, far); };
    if (workload.radii.empty()) return {scaled(workload.disc_radius)};
    std::vector<RadiusClass> classes = workload.radii;
    for (RadiusClass& one : classes) one.radius = scaled(one.radius);
    return BoxEnds(std::move(classes));
  }

  double side_;  ///< length
  BoxEnds ends_;
  double margin_;
  double density_;  ///< Workload::ray_density
  double of_surface_;
  double of_volume_;
};

}  // namespace detp::model::box_tree
