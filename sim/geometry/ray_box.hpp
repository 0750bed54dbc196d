#pragma once

#include <algorithm>
#include <cmath>

#include "geometry.hpp"

namespace detp::sim {

/// An interval on a ray, in distances from the ray's origin (on a line, negative behind the origin).
struct RayInterval {
  double from;
  double to;
  [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// A ray prepared for clipping against boxes.
struct ClippedRay {
  explicit ClippedRay(const Ray& ray)
      : origin(ray.origin), inverse(1.0 / ray.direction), whole{ray.is_line() ? -unbounded : 0.0, ray.length} {}

  glm::dvec3 origin;
  glm::dvec3 inverse;  ///< 1 / direction; infinite along an axis to which the ray is perpendicular
  RayInterval whole;

  /// The interval inside the closed box.
  [[nodiscard]] RayInterval inside(const Box& box) const {
    RayInterval interval = whole;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isinf(inverse[axis])) {
        if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return {0, -1};
        continue;
      }
      const double a = (box.low[axis] - origin[axis]) * inverse[axis];
      const double b = (box.high[axis] - origin[axis]) * inverse[axis];
      interval.from = std::max(interval.from, std::min(a, b));
      interval.to = std::min(interval.to, std::max(a, b));
    }
    return interval;
  }
};

}  // namespace detp::sim
