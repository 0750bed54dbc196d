#pragma once

#include <cmath>

#include "geometry.hpp"

/// Decides whether a ray hits a disc or a sphere. Every technique uses these predicates, so all find the same pairs.
namespace detp::sim {

/// Whether the ray meets the closed sphere.
///
/// Compares the distance between the centre and the ray's nearest point with the radius r. The decision is right if the
/// centre's true distance from the line that the direction spans, or from the segment origin + [0, length] direction,
/// differs from r by more than error_band(ray, sphere). This is about 2.2u|f| + 4ur, where u = 2⁻⁵³ and f is the vector
/// from the ray's origin to the centre. With the discriminant b² - 4ac the error would be of the order of u|f|²/r.
[[nodiscard]] inline bool hits(const Ray& ray, const Sphere& sphere) {
  const glm::dvec3 f = sphere.centre - ray.origin;
  double along = glm::dot(f, ray.direction);
  if (!ray.is_line()) along = along < 0 ? 0 : (along > ray.length ? ray.length : along);
  const glm::dvec3 off = f - along * ray.direction;
  return glm::dot(off, off) <= sphere.radius * sphere.radius;
}

/// A ray is rejected early if it passes a disc's centre at more than this many radii: 1, plus a margin for directions
/// whose length is 1 only to within 1e-12.
inline constexpr double reach = 1 + 2e-12;

/// Whether the ray crosses the disc: the point where it crosses the disc's plane lies within the closed disc and on the
/// ray. A ray parallel to the plane does not hit.
///
/// Needs no division. Let D be the direction, n the normal, d the radius and w the vector from the disc's centre to the
/// ray's origin. The vector from the centre to the crossing is w - D (n·w)/(n·D) = (n × (w × D)) / (n·D), for n and D
/// of any length. The decision is right if the crossing's distance from the centre differs from d by more than
/// error_band(ray, disc).rim / |n·D|, about u(3|w| + 10d)/|n·D|, and each end of a segment is farther from the plane
/// than error_band(ray, disc).ends, about 4u(|w| + length). The bounds are derived in sim/geometry/proofs.md.
///
/// If the disc is seen almost edge-on, rounding decides, and could report a hit far from the disc. Two checks prevent
/// this; they need a D of unit length. First, the distance of the whole line from the centre, |w × D|, must be at most
/// d·reach. Second, if a segment passes all other checks, its distance from the centre must be at most d·reach.
[[nodiscard]] inline bool hits(const Ray& ray, const Disc& disc) {
  const glm::dvec3 w = ray.origin - disc.centre;
  const glm::dvec3 moment = glm::cross(w, ray.direction);
  const double square = disc.radius * disc.radius;
  if (!(glm::dot(moment, moment) <= square * (reach * reach))) return false;
  const double facing = glm::dot(disc.normal, ray.direction);
  if (facing == 0) return false;
  const glm::dvec3 crossing = glm::cross(disc.normal, moment);
  if (!(glm::dot(crossing, crossing) <= square * facing * facing)) return false;
  if (ray.is_line()) return true;
  const double ahead = facing < 0 ? glm::dot(disc.normal, w) : -glm::dot(disc.normal, w);
  if (!(ahead >= 0 && ahead <= ray.length * std::abs(facing))) return false;
  double along = -glm::dot(w, ray.direction);
  along = along < 0 ? 0 : (along > ray.length ? ray.length : along);
  const glm::dvec3 off = w + along * ray.direction;
  return glm::dot(off, off) <= square * (reach * reach);
}

/// Whether the ray arrives on the side that the disc's normal points to.
[[nodiscard]] inline bool arrives_in_front(const Ray& ray, const Disc& disc) {
  return glm::dot(disc.normal, ray.direction) < 0;
}

}  // namespace detp::sim
