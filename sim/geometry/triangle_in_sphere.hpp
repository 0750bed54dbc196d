#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// Area of a triangle's part inside a sphere.
namespace detp::sim {

namespace in_sphere {

[[nodiscard]] inline double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Signed area of the sector of the circle between the directions a and b.
[[nodiscard]] inline double sector(const glm::dvec2& a, const glm::dvec2& b, double radius) {
  return 0.5 * radius * radius * std::atan2(cross(a, b), glm::dot(a, b));
}

/// Signed area of the part of the triangle (0, a, b) in the circle of the radius around 0.
[[nodiscard]] inline double corner_part(const glm::dvec2& a, const glm::dvec2& b, double radius) {
  const double length = glm::length(b - a);
  if (length == 0) return 0;
  const glm::dvec2 along = (b - a) / length;
  const double height = cross(a, along);  // of the line's distance from 0
  const double half = radius * radius - height * height;
  const double from = glm::dot(a, along);  // positions on the line, measured from the foot of 0
  const double to = from + length;
  const double chord = half > 0 ? std::sqrt(half) : 0;
  if (half <= 0 || to <= -chord || from >= chord) return sector(a, b, radius);
  const glm::dvec2 foot = height * glm::dvec2(along.y, -along.x);
  const glm::dvec2 enters = from < -chord ? foot - chord * along : a;
  const glm::dvec2 leaves = to > chord ? foot + chord * along : b;
  double area = 0.5 * cross(enters, leaves);
  if (from < -chord) area += sector(a, enters, radius);
  if (to > chord) area += sector(leaves, b, radius);
  return area;
}

}  // namespace in_sphere

/// Area of the part of the triangle a, b, c that lies in the sphere. The sphere cuts the triangle's plane in a circle; the area
/// is the sum over the edges of the signed areas of the triangles between the circle's centre and the edge, cut by the
/// circle. Coordinates are relative to the sphere's centre. A triangle with its corners in the sphere has its own area.
///
/// Accuracy   relative to the circle's area about 1e-15 (edge length / radius); 0 for a triangle without area
/// Source     our derivation
[[nodiscard]] inline double area_in_sphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                                           double radius) {
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const double doubled = glm::length(across);
  const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
  if (!(doubled > 1e-14 * longest * longest)) return 0;
  const double within = radius * radius;
  if (glm::dot(a, a) <= within && glm::dot(b, b) <= within && glm::dot(c, c) <= within) return 0.5 * doubled;
  const glm::dvec3 normal = across / doubled;
  const double height = glm::dot(normal, a);
  const double square = within - height * height;
  if (!(square > 0)) return 0;
  const glm::dvec3 x = glm::normalize(b - a);
  const glm::dvec3 y = glm::cross(normal, x);
  const auto flat = [&](const glm::dvec3& point) { return glm::dvec2(glm::dot(point, x), glm::dot(point, y)); };
  const std::array corners{flat(a), flat(b), flat(c)};
  const double cut = std::sqrt(square);
  double area = 0;
  for (std::size_t i = 0; i < 3; ++i) area += in_sphere::corner_part(corners[i], corners[(i + 1) % 3], cut);
  return std::clamp(area, 0.0, 0.5 * doubled);
}

}  // namespace detp::sim
