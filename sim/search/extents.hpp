#pragma once

#include <span>

#include "detp/sim/geometry/geometry.hpp"

/// What one pass over rays or discs finds, some of them at a time, with vectors. The values do not depend on the order, nor on the
/// instruction set. They are meaningless for rays or discs that are not sound.
namespace detp::sim {

struct DiscExtent {
  Box centres;
  double smallest = unbounded;  ///< radius
  double largest = 0;
  bool sound = true;  ///< by surely_sound (soundness.hpp)
};

struct RayExtent {
  double farthest2 = 0;  ///< squared distance of the farthest origin from the given centre
  double least_power = unbounded;
  double most_power = 0;
  double least_length = unbounded;
  bool sound = true;  ///< likewise: origins in range, unit directions, lengths > 0, powers from 0 to `power_limit`
};

[[nodiscard]] DiscExtent extent_of(std::span<const Disc> discs);
[[nodiscard]] RayExtent extent_of(std::span<const Ray> rays, const glm::dvec3& centre, double power_limit);

[[nodiscard]] DiscExtent joined(const DiscExtent& a, const DiscExtent& b);
[[nodiscard]] RayExtent joined(const RayExtent& a, const RayExtent& b);

}  // namespace detp::sim
