#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// Intersection of a ray with a triangle, in double precision. Coordinates are at most about 1 in size.
namespace detp::sim {

/// Slack at a triangle's edges, as a share of its height, so that rounding lets no ray through between two triangles.
inline constexpr double facet_edge_slack = 1e-10;
/// A ray that starts this close to a triangle's plane counts as starting on it, and does not meet the triangle.
inline constexpr double facet_plane_slack = 1e-13;
/// A triangle whose doubled area is below this share of its longest edge squared counts as a triangle without area: the
/// computed area is rounding error.
inline constexpr double least_facet_area = 1e-14;

/// A triangle prepared for intersection.
struct Facet {
  glm::dvec3 corner;
  glm::dvec3 first;   ///< edge from the corner
  glm::dvec3 second;  ///< the other edge from the corner
  glm::dvec3 normal;  ///< unit length, or zero for a triangle without area
};

/// The facet with three corners in this order.
[[nodiscard]] inline Facet make_facet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const double area = glm::length(across);
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - a, c - a), glm::dot(c - b, c - b)});
  return {a, b - a, c - a, area > least_facet_area * longest ? across / area : glm::dvec3{0.0}};
}

/// Distance along the ray to the facet; unbounded if the ray does not cross it.
[[nodiscard]] inline double crossing(const glm::dvec3& origin, const glm::dvec3& direction, const Facet& facet) {
  const glm::dvec3 back = origin - facet.corner;
  const double height = -glm::dot(facet.normal, back);
  const double facing = glm::dot(facet.normal, direction);
  if (facing == 0 || std::abs(height) <= facet_plane_slack || (height < 0) != (facing < 0)) return unbounded;
  // Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
  const glm::dvec3 h = glm::cross(direction, facet.second);
  const double determinant = glm::dot(facet.first, h);
  const double u = glm::dot(back, h) / determinant;
  const double v = glm::dot(direction, glm::cross(back, facet.first)) / determinant;
  const bool inside = u >= -facet_edge_slack && v >= -facet_edge_slack && u + v <= 1 + facet_edge_slack;
  return inside ? height / facing : unbounded;
}

/// The distinct facets that a ray can meet, each with the lowest number among its triangles.
///
/// Two kinds of facets are left out, which changes no result: facets without area, which no ray meets; and facets with
/// the same bits as an earlier facet, since a ray meets both at the same distance, and then the lower number counts.
/// Any number of triangles with the same corners give at most six facets, one for each order of the corners.
struct DistinctFacets {
  std::vector<Facet> facets;
  std::vector<std::uint32_t> triangles;  ///< the triangle of each facet; ascending
  std::vector<std::uint32_t> places;     ///< for each triangle its facet, or no_facet
};

inline constexpr std::uint32_t no_facet = UINT32_MAX;

/// `all` holds the facet of each triangle, in order; there must be fewer than 2³² - 1. Cost O(triangles). Throws
/// Stopped if a stop was requested.
[[nodiscard]] DistinctFacets distinct_facets(std::vector<Facet> all, const std::stop_token& stop = {});

}  // namespace detp::sim
