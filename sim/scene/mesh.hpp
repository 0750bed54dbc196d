#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

/// Triangle meshes, and the samples at their vertices.
namespace detp::sim {

struct Mesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> normals;                      ///< one per position, or none at all; not necessarily unit
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions, all in range
};

/// Remarks for the user that are no errors: "12 unreferenced vertices dropped".
using Notices = std::vector<std::string>;

/// One sample at each vertex that a triangle uses, in vertex order.
///
/// Normals are the mesh's own where it has them, else the area-weighted mean of the triangles around the vertex.
/// Unreferenced vertices are dropped; where no normal can be found (all triangles around it have no area, or the
/// file's normal is zero) the vertex is dropped too. Each kind of drop adds one notice with its count.
/// Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<Sample> samples_at_vertices(const Mesh& mesh, Notices& notices,
                                                      const std::stop_token& stop = {});

/// Mean length of the mesh's edges, each counted once; 0 without triangles. An estimate of the distance between
/// neighbouring samples at vertices. Throws Stopped if a stop was requested.
[[nodiscard]] double mean_edge_length(const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
