#pragma once

#include <cstddef>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "mesh.hpp"

/// The samples on the faces that a user names.
namespace detp::sim {

/// Faces with one of these materials, if there are any here, that are in one of these groups, if there are any here.
struct FaceNames {
  std::vector<std::string> materials = {};  ///< of the front, or of a back that has its own
  std::vector<std::string> groups = {};     ///< or objects

  [[nodiscard]] bool empty() const { return materials.empty() && groups.empty(); }
};

/// For each triangle, whether it is named; without names, all are. Throws std::invalid_argument, with some of the known
/// names, for a name that no material, or no group, of the mesh has; and as check(Materials).
[[nodiscard]] std::vector<bool> triangles_named(const Mesh& mesh, const FaceNames& names);

/// Indices, in rising order, of the samples that lie on the chosen ones of the mesh's triangles, whose vertices have one normal each
/// (vertices.hpp).
///
/// A sample at a vertex, with its normal to 1e-6, lies on all triangles with this vertex. Another sample lies on the nearest
/// triangle, and on those that are as near to 10⁻⁹ of the diagonal of the box around the mesh. Triangles farther away than 10⁻⁶ of
/// it, and those whose normal is not within 60° of the sample's, do not count.
///
/// Cost O(n log n). Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<std::size_t> samples_on(const Mesh& mesh, std::span<const Sample> samples,
                                                  const std::vector<bool>& chosen, const std::stop_token& stop = {});

/// The same for triangles that are named. Throws std::invalid_argument as triangles_named, and if there is no such sample.
[[nodiscard]] std::vector<std::size_t> samples_named(const Mesh& mesh, std::span<const Sample> samples,
                                                     const FaceNames& names, const std::stop_token& stop = {});

}  // namespace detp::sim
