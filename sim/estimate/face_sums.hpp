#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/scene/mesh.hpp"
#include "detp/sim/search/outcome.hpp"

/// The light on faces: photons that land on triangles, without discs and without a radius.
namespace detp::sim {

/// Parts of a mesh's surface, each some of its triangles. A triangle may be in several.
struct SurfaceParts {
  std::vector<std::string> names = {};                ///< empty: parts are the triangles
  std::vector<double> areas = {};                     ///< of each part
  std::vector<std::vector<std::uint32_t>> sets = {};  ///< sets of parts
  std::vector<std::uint32_t> set_of_triangle = {};    ///< index into `sets`; parts are the triangles if there are none

  /// Those that have the triangle.
  [[nodiscard]] std::span<const std::uint32_t> parts_of(const std::uint32_t& triangle) const {
    return set_of_triangle.empty() ? std::span(&triangle, 1) : std::span(sets[set_of_triangle[triangle]]);
  }
};

/// The normal of the triangle's front, as long as its area.
[[nodiscard]] glm::dvec3 area_vector(const Mesh& mesh, std::uint32_t triangle);

/// Each triangle a part.
[[nodiscard]] SurfaceParts parts_by_triangle(const Mesh& mesh);
/// By the material of the front.
[[nodiscard]] SurfaceParts parts_by_material(const Mesh& mesh);
/// By group or object; without those that no triangle is in.
[[nodiscard]] SurfaceParts parts_by_group(const Mesh& mesh);

/// Hits, irradiance and errors of each part, in all bands: of a part's photons, as of a disc's in irradiance.hpp, over its area. The light of a
/// part is its irradiance times its area.
///
/// Hits are rays that end on one of the part's triangles; with `front_facing` only those that arrive at its front. A photon that lands on a part
/// several times counts as one in its errors. Light on a part without area, or that none reaches, is 0, with its bound.
/// Throws std::invalid_argument unless rays know their triangles; as make_problem; Stopped.
[[nodiscard]] Outcome sums_of_parts(const PathRays& rays, const Mesh& mesh, const SurfaceParts& parts,
                                    bool front_facing, const RunOptions& options);

}  // namespace detp::sim
