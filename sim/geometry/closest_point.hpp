#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace detp::sim {

/// The point of a triangle a, b, c that is nearest to 0, by its weights: it is x a + y b + z c, x + y + z = 1, none negative.
/// Of a triangle without area, some point of its longest edge. Source: our derivation; the regions in which a corner, an edge or
/// the inside is nearest are told apart by signs of scalar products.
[[nodiscard]] inline glm::dvec3 closest_point_weights(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto on_edge = [](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 edge = to - from;
    const double square = glm::dot(edge, edge);
    return square > 0 ? std::clamp(-glm::dot(from, edge) / square, 0.0, 1.0) : 0.0;
  };
  const double ab = on_edge(a, b);
  const double bc = on_edge(b, c);
  const double ca = on_edge(c, a);
  glm::dvec3 best(1 - ab, ab, 0);
  double least = glm::dot(a + ab * (b - a), a + ab * (b - a));
  const auto consider = [&](const glm::dvec3& weights) {
    const glm::dvec3 point = weights.x * a + weights.y * b + weights.z * c;
    if (const double square = glm::dot(point, point); square < least) {
      least = square;
      best = weights;
    }
  };
  consider({0, 1 - bc, bc});
  consider({ca, 0, 1 - ca});
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double square = glm::dot(normal, normal);
  if (!(square > 0)) return best;
  const glm::dvec3 inside(glm::dot(normal, glm::cross(b, c)), glm::dot(normal, glm::cross(c, a)),
                          glm::dot(normal, glm::cross(a, b)));
  if (std::min({inside.x, inside.y, inside.z}) >= 0) consider(inside / (inside.x + inside.y + inside.z));
  return best;
}

/// The distance of 0 from a triangle.
[[nodiscard]] inline double distance_to_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 weights = closest_point_weights(a, b, c);
  return glm::length(weights.x * a + weights.y * b + weights.z * c);
}

}  // namespace detp::sim
