#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Levels of cells of Lebesgue's curve: on each level, a cell is halved along all three axes.
inline constexpr int levels_of_cells = 16;

/// A disc in floats. Lengths are in the unit of the sample, from its origin.
struct SampledDisc {
  glm::vec3 centre{0};
  glm::vec3 steepness{0, 0, 1};  ///< |n_i| of the normal along each axis
  std::uint32_t number = 0;      ///< in the array of all discs
};

/// Some discs in the order of Lebesgue's curve through their box: that of cells on every level.
struct CurveSample {
  std::vector<SampledDisc> discs;
  std::vector<std::uint64_t> keys;  ///< their places on the curve, in rising order
  glm::dvec3 origin{0.0};
  double unit = 1;  ///< length
};

/// The discs with the numbers in `sample`. The sphere's centre becomes the origin, its radius the unit; it must contain
/// the centres. Throws Stopped if a stop was requested.
[[nodiscard]] CurveSample curve_sample(std::span<const Disc> discs, std::span<const std::size_t> sample,
                                       const Sphere& sphere, const std::stop_token& stop = {});

/// The same of at most `most` discs, stratified.
[[nodiscard]] CurveSample curve_sample(std::span<const Disc> discs, const Sphere& sphere, std::size_t most = 1U << 13,
                                       const std::stop_token& stop = {});

}  // namespace detp::sim
