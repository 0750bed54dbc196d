#pragma once

#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads a triangle mesh. The ending of the file's name, .obj or .ply in any case, decides the format.
///
/// Polygons are split into fans from their first corner. Triangles without area are kept (samples_at_vertices handles
/// them). Throws FileError for unreadable, empty, truncated or malformed files, indices out of range, positions that
/// are not finite and that a face uses, files without a face, and other endings. Positions that are not finite and
/// unused are set to 0, with a notice. Throws std::length_error if the mesh would not fit in memory, and Stopped within
/// 0.1 s of a stop request.
[[nodiscard]] Mesh read_mesh(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
