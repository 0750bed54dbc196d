#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace detp::sim {

/// The vector scaled to length 1. Components of 1e-300 and 1e300 neither vanish nor overflow. Zero stays zero. A vector
/// whose length is 1 within rounding is returned unchanged, so vectors that are written to a file are read back
/// unchanged, as is one that is not finite.
[[nodiscard]] inline glm::dvec3 unit_or_zero(const glm::dvec3& vector) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  const double square = glm::dot(vector, vector);
  if (std::abs(square - 1) <= rounding) return vector;
  if (square > 1e-200 && square < 1e200) return vector * (1 / std::sqrt(square));
  if (!std::isfinite(vector.x) || !std::isfinite(vector.y) || !std::isfinite(vector.z)) return vector;
  const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
  if (largest == 0) return glm::dvec3{0.0};
  return glm::normalize(vector / largest);
}

}  // namespace detp::sim
