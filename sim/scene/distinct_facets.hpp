#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "facet.hpp"

namespace detp::sim {

/// The distinct facets that a ray can meet. Each is listed under the lowest number of a triangle that has it.
///
/// Leaves out facets without area, which no ray meets, and facets with the same bits as an earlier one: a ray meets
/// both at the same distance, and then the lower number counts. So leaving them out changes no result. Of any number of
/// triangles with the same corners at most six facets are left, one for each order of the corners.
struct DistinctFacets {
  std::vector<Facet> facets;
  std::vector<std::uint32_t> triangles;  ///< the triangle of each facet; ascending
  std::vector<std::uint32_t> places;     ///< for each triangle its facet, or no_facet
};

inline constexpr std::uint32_t no_facet = UINT32_MAX;

/// `all` holds the facets of all triangles in order, fewer than 2³² - 1. Cost O(triangles). Throws Stopped if a stop
/// was requested.
[[nodiscard]] DistinctFacets distinct_facets(std::vector<Facet> all, const std::stop_token& stop = {});

}  // namespace detp::sim
