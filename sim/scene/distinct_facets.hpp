#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "facet.hpp"

namespace detp::sim {

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
