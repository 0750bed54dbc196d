#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace detp::sim {

/// The axis (0, 1, 2) along which a direction has its largest component; the lowest axis if two are equal.
///
/// The axis sorts rays into three classes. A ray is at most 55° from the axis of its class. Powers are summed by class
/// (Outcome::irradiance), so an engine may process the classes one after another.
[[nodiscard]] inline int dominant_axis(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

}  // namespace detp::sim
