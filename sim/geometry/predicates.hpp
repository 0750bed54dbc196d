#pragma once

#include <cmath>

#include "geometry.hpp"

/// The one definition of what hits what. Every technique decides by these, so that all find the same pairs.
namespace detp::sim {

/// Whether the ray comes within the closed sphere.
///
/// By the distance of the centre from the ray, perpendicular to it: the error is about ε|f|, f the vector from the
/// ray's origin to the centre, where the discriminant b² - 4ac would have ε|f|²/r. It is decided rightly, for the line
/// that the direction spans or the segment origin + [0, length] direction, wherever the true distance differs from the
/// radius by more than error_band(ray, sphere), about 2.2u|f| + 4ur (u = 2⁻⁵³).
[[nodiscard]] inline bool hits(const Ray& ray, const Sphere& sphere) {
  const glm::dvec3 f = sphere.centre - ray.origin;
  double along = glm::dot(f, ray.direction);
  if (!ray.is_line()) along = along < 0 ? 0 : (along > ray.length ? ray.length : along);
  const glm::dvec3 off = f - along * ray.direction;
  return glm::dot(off, off) <= sphere.radius * sphere.radius;
}

/// How far, in radii, a ray may pass a disc's centre and still be looked at: 1, and more than a direction that is unit
/// to 1e-12 can mistake.
inline constexpr double reach = 1 + 2e-12;

/// Whether the ray crosses the disc: the point where it crosses the disc's plane lies within the closed disc and on the
/// ray. A ray parallel to the plane does not hit.
///
/// Without division: with D the direction, n the normal and w the vector from the disc's centre to the origin, the
/// crossing lies w - D (n·w)/(n·D) = (n × (w × D)) / (n·D) from the centre: neither n nor D need be unit. It is decided
/// rightly wherever the crossing's distance from the centre differs from d by more than error_band(ray, disc).rim /
/// |n·D|, about u(3|w| + 10d)/|n·D|, and no end of a segment lies within error_band(ray, disc).ends of the plane, about
/// 4u(|w| + length). The bounds are derived in sim/README.md, "Geometry".
///
/// Near the edge-on view rounding decides, and could decide for a hit far from the disc. Two questions forbid that.
/// |w × D| is the distance of the whole line from the centre: more than d, and nothing more need be asked. A segment
/// that is about to be taken must itself come as near as d to the centre, which only hits are asked.
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

/// Whether the ray arrives at the face that the disc's normal points out of.
[[nodiscard]] inline bool arrives_in_front(const Ray& ray, const Disc& disc) {
  return glm::dot(disc.normal, ray.direction) < 0;
}

}  // namespace detp::sim
