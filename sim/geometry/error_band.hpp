#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry.hpp"

/// How near to a shape's boundary a predicate may decide wrongly. Proved in sim/geometry/proofs.md. The bounds hold if
/// no square under- or overflows (make_problem's limits), and directions and normals have length 1 to within 1e-12.
namespace detp::sim {

/// u = 2⁻⁵³: half the distance from 1 to the next double.
inline constexpr double rounding_unit = 0.5 * std::numeric_limits<double>::epsilon();

/// A predicate computes the point of a ray that is nearest to a centre. Returns a bound on that point's error along the
/// ray, which comes from rounding and from a direction that is not exactly of unit length. `distance` is the distance
/// between the ray's origin and the centre.
[[nodiscard]] inline double displacement(const Ray& ray, double distance) {
  return (std::abs(glm::dot(ray.direction, ray.direction) - 1) + 8 * rounding_unit) * distance;
}

/// hits(ray, sphere) is right if the true distance of the centre from the ray differs from the radius by more than
///   u(2.2|f| + 4r) + s min(1, 2s/r),   s = (| |D|² - 1 | + 8u) |f|.
///
/// | symbol | unit   | meaning                                              |
/// |--------|--------|------------------------------------------------------|
/// | f      | length | from the ray's origin to the sphere's centre         |
/// | r, D   |        | radius; direction                                    |
/// | s      | length | how far the nearest point is displaced along the ray |
[[nodiscard]] inline double error_band(const Ray& ray, const Sphere& sphere) {
  const double f = glm::distance(sphere.centre, ray.origin);
  const double s = displacement(ray, f);
  return rounding_unit * (2.2 * f + 4 * sphere.radius) + s * std::min(1.0, 2 * s / sphere.radius);
}

/// Bounds within which hits(ray, disc) may be wrong; n is the disc's normal, D the ray's direction.
struct DiscBand {
  double rim;   ///< length; hits() may be wrong if the crossing is within rim/|n·D| of the disc's rim
  double ends;  ///< length; segments only: hits() may be wrong if an end is within this distance of the disc's plane
};

/// hits(ray, disc) is right if | |n × (w × D)| - d |n·D| | > rim and, for segments, both |n·w| > ends and
/// |n·w + length n·D| > ends, with
///   rim = u(3|w| + 10d), plus s min(1, 2s/d) for segments;   ends = 4.01 u(|w| + length).
///
/// | symbol | unit   | meaning                                              |
/// |--------|--------|------------------------------------------------------|
/// | w      | length | from the disc's centre to the ray's origin           |
/// | d, n   |        | radius; normal                                       |
/// | D      |        | the ray's direction                                  |
/// | s      | length | (| |D|² - 1 | + 8u) |w|; matters if |w| > 5·10⁷ d    |
[[nodiscard]] inline DiscBand error_band(const Ray& ray, const Disc& disc) {
  const double w = glm::distance(ray.origin, disc.centre);
  const double rim = rounding_unit * (3 * w + 10 * disc.radius);
  if (ray.is_line()) return {rim, 0};
  const double s = displacement(ray, w);
  return {rim + s * std::min(1.0, 2 * s / disc.radius), 4.01 * rounding_unit * (w + ray.length)};
}

}  // namespace detp::sim
