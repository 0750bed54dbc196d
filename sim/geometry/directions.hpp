#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace detp::sim {

/// Two unit vectors that with the unit vector `axis` form a right-handed orthonormal basis (first × second = axis).
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1) 2017: no branch, no singularity.
[[nodiscard]] std::array<glm::dvec3, 2> basis_around(const glm::dvec3& axis);

/// Uniform on the unit sphere, from two uniform numbers in [0, 1).
[[nodiscard]] glm::dvec3 uniform_direction(double u, double v);

/// Cosine-distributed around the unit vector `axis`, from two uniform numbers in [0, 1).
[[nodiscard]] glm::dvec3 cosine_direction(const glm::dvec3& axis, double u, double v);

}  // namespace detp::sim
