#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/scene/material.hpp"

namespace detp::sim {

/// The direction in which a photon leaves a surface, or nothing if the surface absorbs it: Russian roulette by the
/// material's shares, so the photon's power stays the same. Determined by four uniform numbers in [0, 1). All
/// distributions map uniform light from all directions to uniform light: they are reciprocal.
///
/// Diffuse    the cosine law, on the side from which the photon came.
/// Specular   the projection of the direction on the surface, a point of the unit disc, moves from that of the mirror
///            direction by normally distributed steps of standard deviation 1 / sqrt(shininess) along both axes; where
///            it would leave the disc, the photon takes the mirror direction. So the lobe depends on the difference of
///            direction cosines alone (as in J. E. Harvey, Light-Scattering Characteristics of Optical Surfaces, 1976);
///            near the normal it is Phong's of that exponent.
/// Glass      reflected with the probability of Fresnel's equations for unpolarised light, else refracted; totally
///            reflected beyond the critical angle. The front is the side to which the normal points.
///
/// `normal` and `incoming` are unit vectors; `incoming` points to the surface.
[[nodiscard]] std::optional<glm::dvec3> scattered(const Material& material, const glm::dvec3& normal,
                                                  const glm::dvec3& incoming, const std::array<double, 4>& random);

/// By which of a material's shares a photon is scattered.
enum class ScatteredBy : std::uint8_t { diffuse, specular, glass };

struct Scattered {
  glm::dvec3 direction;
  ScatteredBy by;
};

/// Probabilities, in place of a material's shares.
struct Shares {
  double diffuse, specular, glass;
};

/// As `scattered`, by these probabilities, and by what.
[[nodiscard]] std::optional<Scattered> scattered_by(const Material& material, const Shares& shares,
                                                    const glm::dvec3& normal, const glm::dvec3& incoming,
                                                    const std::array<double, 4>& random);

/// The side of a triangle that a photon meets.
struct Side {
  const Material& material;
  glm::dvec3 normal;  ///< of the triangle whose material this is: a back with a material of its own is another's front
};

/// `normal`: of the triangle.
[[nodiscard]] inline Side side_met(const Materials& materials, std::size_t triangle, const glm::dvec3& normal,
                                   const glm::dvec3& incoming) {
  if (!materials.has_back(triangle) || glm::dot(incoming, normal) < 0) return {materials.of(triangle), normal};
  return {materials.of(triangle, false), -normal};
}

/// Fresnel's reflectance of unpolarised light at a boundary between two dielectrics; 1 beyond the critical angle.
/// `cosine`: of the angle between incoming light and normal, in (0, 1]. `index`: behind the boundary over before it.
[[nodiscard]] double fresnel_reflectance(double cosine, double index);

}  // namespace detp::sim
