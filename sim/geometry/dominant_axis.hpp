#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace detp::sim {

/// The axis (0, 1, 2) along which a direction goes farthest; of equals the lowest.
///
/// It sorts rays into three classes, in each of which a ray crosses planes across one axis at no more than 55°. Powers
/// are summed by class, so that an engine may take the classes one after another (Outcome::irradiance).
[[nodiscard]] inline int dominant_axis(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

}  // namespace detp::sim
