#pragma once

#include <cmath>

#include "geometry.hpp"

/// The one definition of what hits what. Every technique decides by these, so that all find the same pairs.
namespace detp::sim {

/// Whether the ray comes within the closed sphere.
///
/// By the distance of the centre from the ray, perpendicular to it: the error is about ε|f|/r, f the vector from the
/// ray's origin to the centre, where the discriminant b² - 4ac would have ε|f|²/r².
[[nodiscard]] inline bool hits(const Ray& ray, const Sphere& sphere) {
  const glm::dvec3 f = sphere.centre - ray.origin;
  double along = glm::dot(f, ray.direction);
  if (!ray.is_line()) along = along < 0 ? 0 : (along > ray.length ? ray.length : along);
  const glm::dvec3 off = f - along * ray.direction;
  return glm::dot(off, off) <= sphere.radius * sphere.radius;
}

/// How far beyond its radius a ray that passes a disc is still looked at: more than the rounding of what follows.
inline constexpr double rim = 1 + 1e-12;

/// Whether the ray crosses the disc: the point where it crosses the disc's plane lies within the closed disc and on the
/// ray. A ray parallel to the plane does not hit.
///
/// Without division: with D the direction, n the normal and w the vector from the disc's centre to the origin, the
/// crossing lies w - D (n·w)/(n·D) = (n × (w × D)) / (n·D) from the centre. Error about ε|w|/(d |n·D|). |w × D| is the
/// distance of the whole line from the centre: where that exceeds d nothing more need be asked, and what is decided
/// near the edge-on view can then never be a hit far from the disc.
[[nodiscard]] inline bool hits(const Ray& ray, const Disc& disc) {
  const glm::dvec3 w = ray.origin - disc.centre;
  const glm::dvec3 moment = glm::cross(w, ray.direction);
  const double square = disc.radius * disc.radius;
  if (!(glm::dot(moment, moment) <= square * rim)) return false;
  const double facing = glm::dot(disc.normal, ray.direction);
  if (facing == 0) return false;
  const glm::dvec3 crossing = glm::cross(disc.normal, moment);
  if (!(glm::dot(crossing, crossing) <= square * facing * facing)) return false;
  if (ray.is_line()) return true;
  const double ahead = facing < 0 ? glm::dot(disc.normal, w) : -glm::dot(disc.normal, w);
  return ahead >= 0 && ahead <= ray.length * std::abs(facing);
}

/// Whether the ray arrives at the face that the disc's normal points out of.
[[nodiscard]] inline bool arrives_in_front(const Ray& ray, const Disc& disc) {
  return glm::dot(disc.normal, ray.direction) < 0;
}

}  // namespace detp::sim
