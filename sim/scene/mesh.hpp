#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "material.hpp"

/// Triangle meshes.
namespace detp::sim {

/// How the faces of a file were divided into triangles.
struct PolygonCounts {
  std::uint64_t split = 0;  ///< polygons that no fan of triangles around a corner fills
  std::uint64_t not_plane =
      0;  ///< polygons whose corners are off their mean plane by more than a thousandth of their extent
  std::uint64_t degenerate = 0;  ///< polygons without area, or that cross themselves
};

/// The names of a mesh's faces, as in OBJ: those of the object and of the groups that a face is in.
struct Groups {
  std::vector<std::string> names = {};                ///< in the order of the file; there may be some that no face has
  std::vector<std::vector<std::uint32_t>> sets = {};  ///< sets of names: rising indices into `names`
  std::vector<std::uint32_t> of_triangle = {};        ///< indices into `sets`; none: no triangle has a name
};

struct Mesh {
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> normals;  ///< one for each position, or none at all; not necessarily of unit length
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions, all in range
  Materials materials = {};
  Groups groups = {};
  PolygonCounts polygons = {};  ///< of the file
  std::vector<std::uint32_t> file_vertices =
      {};  ///< the number in the file, from 0, of each position; empty: its place
  std::uint64_t normals_made =
      0;  ///< corners whose normal the file lacks or has as zero, NaN or infinite, if it has others
  std::uint64_t coincident = 0;  ///< triangles that lie where an earlier one does, wholly or in part
};

/// Messages for the user that are not errors: "12 unreferenced vertices dropped".
using Notices = std::vector<std::string>;

/// The box around the positions that triangles use.
[[nodiscard]] Box used_box(const Mesh& mesh);

/// Mean length of the mesh's edges, an estimate of the distance between neighbouring samples at vertices. An edge of
/// several triangles, between the same two positions, counts once, an edge of length 0 not at all. Returns 0 if no edge counts. Throws Stopped if a stop
/// was requested.
[[nodiscard]] double mean_edge_length(const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
