#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory_resource>
#include <numbers>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// Sums over rays, in the order that all techniques use.
namespace detp::sim {

/// The sums over the rays that hit one disc.
struct DiscTotals {
  std::uint64_t hits = 0;
  glm::dvec3 power{0.0};  ///< by the rays' dominant_axis: three sums, each in ray order
};

/// The totals of each disc, in the order of the discs. (32 bytes per disc: in an
/// aligned array, as in a Scratch, a hit touches one cache line.)
using Totals = std::pmr::vector<DiscTotals>;

/// Power divided by the disc's area.
[[nodiscard]] inline double irradiance(const DiscTotals& totals, const Disc& disc) {
  const glm::dvec3& power = totals.power;
  return ((power.x + power.y) + power.z) / (std::numbers::pi * disc.radius * disc.radius);
}

}  // namespace detp::sim
