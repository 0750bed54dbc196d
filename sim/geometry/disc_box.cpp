#include "disc_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "directions.hpp"

namespace detp::sim {
namespace {

/// A convex polygon of at most 4 + 6 corners.
struct Polygon {
  std::array<glm::dvec3, 10> corners;
  std::size_t count = 0;
  void add(const glm::dvec3& corner) { corners[count++] = corner; }
};

/// The square around the disc in the disc's plane, relative to the disc's centre.
Polygon square_around(const Disc& disc) {
  const auto [u, v] = basis_around(disc.normal);
  const double r = disc.radius;
  Polygon square;
  square.add(r * (u + v));
  square.add(r * (v - u));
  square.add(-r * (u + v));
  square.add(r * (u - v));
  return square;
}

/// The part of the polygon on which side · (x[axis] - limit) <= 0.
Polygon clip(const Polygon& polygon, int axis, double limit, double side) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3& a = polygon.corners[i];
    const glm::dvec3& b = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
    const double above_a = side * (a[axis] - limit);
    const double above_b = side * (b[axis] - limit);
    if (above_a <= 0) kept.add(a);
    if ((above_a <= 0) != (above_b <= 0)) kept.add(a + above_a / (above_a - above_b) * (b - a));
  }
  return kept;
}

double square_distance_to_origin(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 edge = b - a;
  const double length = glm::dot(edge, edge);
  const double place = length > 0 ? std::clamp(-glm::dot(a, edge) / length, 0.0, 1.0) : 0;
  const glm::dvec3 nearest = a + place * edge;
  return glm::dot(nearest, nearest);
}

bool within(const Polygon& polygon, double radius) {
  for (std::size_t i = 0; i < polygon.count; ++i)
    if (square_distance_to_origin(polygon.corners[i], polygon.corners[i + 1 < polygon.count ? i + 1 : 0]) <=
        radius * radius)
      return true;
  return false;
}

}  // namespace

Box bounds(const Disc& disc, double slack) {
  // The sine of the angle between the normal and each axis, from the normal's other two components. Computed from its
  // component n along the axis, √(1 - n²) would be 0 for angles below 1e-8.
  const glm::dvec3 square = disc.normal * disc.normal;
  const glm::dvec3 tilt{std::sqrt(square.y + square.z), std::sqrt(square.z + square.x), std::sqrt(square.x + square.y)};
  const glm::dvec3 extent = disc.radius * tilt + slack;
  return {disc.centre - extent, disc.centre + extent};
}

bool overlaps(const Disc& disc, const Box& box, double slack) {
  const glm::dvec3 low = box.low - disc.centre - slack;
  const glm::dvec3 high = box.high - disc.centre + slack;
  bool centre_inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] > disc.radius || high[axis] < -disc.radius) return false;
    centre_inside = centre_inside && low[axis] <= 0 && high[axis] >= 0;
  }
  if (centre_inside) return true;
  const glm::dvec3 middle = 0.5 * (low + high);
  const glm::dvec3 half = 0.5 * (high - low);
  if (std::abs(glm::dot(disc.normal, middle)) > glm::dot(glm::abs(disc.normal), half)) return false;
  Polygon polygon = square_around(disc);
  for (int axis = 0; axis < 3 && polygon.count > 0; ++axis) {
    polygon = clip(polygon, axis, high[axis], 1);
    polygon = clip(polygon, axis, low[axis], -1);
  }
  return within(polygon, disc.radius + slack);
}

}  // namespace detp::sim
