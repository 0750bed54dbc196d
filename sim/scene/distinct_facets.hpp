#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "facet.hpp"

namespace detp::sim {

/// The facets that a ray can meet, each once, by the least number of a triangle that has it.
///
/// Without those without area, which nothing meets, and without those that have the same bits as an earlier one: they
/// are met at the same distance, where the lower number counts. So leaving them out changes no answer, and of any
/// number of triangles with the same corners at most six are left, one for each order of the corners.
struct DistinctFacets {
  std::vector<Facet> facets;
  std::vector<std::uint32_t> triangles;  ///< of each facet; ascending
  std::vector<std::uint32_t> places;     ///< of each triangle: its facet, or no_facet
};

inline constexpr std::uint32_t no_facet = UINT32_MAX;

/// Takes the facets of all triangles, in their order; fewer than 2³² - 1. Cost O(triangles). Throws Stopped if a stop
/// was requested.
[[nodiscard]] DistinctFacets distinct_facets(std::vector<Facet> all, const std::stop_token& stop = {});

}  // namespace detp::sim
