#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detp/validate/job/job.hpp"

/// Triangles whose corners, or which themselves, belong to discs.
namespace detp::validate {

/// The triangles of the scene's mesh, with the numbers of the discs at their corners; none unless each corner has one. A vertex where edges are
/// sharp has a disc for each of its normals: that whose normal is nearest to the triangle's.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles_of_discs(const Job& job);

/// Discs as polygons, `triangles_each` triangles each, one disc after the other.
struct DiscPolygons {
  sim::Mesh mesh;
  std::uint32_t triangles_each = 1;
};

/// Polygons have 18 corners, fewer if that were more than some million triangles.
[[nodiscard]] DiscPolygons polygons_of(std::span<const sim::Disc> discs);

}  // namespace detp::validate
