#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "material.hpp"

/// Triangle meshes, and the samples at their vertices.
namespace detp::sim {

struct Mesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> normals;  ///< one for each position, or none at all; not necessarily of unit length
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions, all in range
  Materials materials = {};
};

/// Messages for the user that are not errors: "12 unreferenced vertices dropped".
using Notices = std::vector<std::string>;

/// One sample at each vertex that a triangle uses, in vertex order.
///
/// The normals are those of the mesh if it has any, else area-weighted mean normals of the triangles around each
/// vertex. Unreferenced vertices are dropped. So are vertices without a normal: all triangles around them have no area,
/// or the file's normal is zero. Each kind of drop adds one notice with its count. Throws Stopped if a stop was
/// requested.
[[nodiscard]] std::vector<Sample> samples_at_vertices(const Mesh& mesh, Notices& notices,
                                                      const std::stop_token& stop = {});

/// Mean length of the mesh's edges, an estimate of the distance between neighbouring samples at vertices. An edge of
/// several triangles counts once, an edge of length 0 not at all. Returns 0 if no edge counts. Throws Stopped if a stop
/// was requested.
[[nodiscard]] double mean_edge_length(const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
