#pragma once

#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads a triangle mesh. The ending of the file's name, .obj or .ply in upper or lower case, decides the format.
///
/// Polygons are split into fans from their first corner. Triangles without area are kept (samples_at_vertices handles
/// them). Positions and normals that are not finite are set to 0 if no face uses them, with a notice for positions.
///
/// Throws FileError for unreadable, empty, truncated or malformed files, indices out of range, files without a face,
/// names with other endings, and if a face uses a position or normal that is not finite. Throws std::length_error if
/// the mesh would not fit in memory, and Stopped within 0.1 s of a stop request.
[[nodiscard]] Mesh read_mesh(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
