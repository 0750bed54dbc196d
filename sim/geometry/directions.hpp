#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace detp::sim {

/// Two unit vectors that with the unit vector `axis` form a right-handed orthonormal basis (first × second = axis).
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1) 2017: no branch, no singularity.
[[nodiscard]] std::array<glm::dvec3, 2> basis_around(const glm::dvec3& axis);

/// Uniform on the unit sphere, from two uniform numbers in [0, 1).
[[nodiscard]] glm::dvec3 uniform_direction(double u, double v);

/// Cosine-distributed around the unit vector `axis`, from two uniform numbers in [0, 1).
[[nodiscard]] glm::dvec3 cosine_direction(const glm::dvec3& axis, double u, double v);

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
