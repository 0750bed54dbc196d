#pragma once

#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads a triangle mesh; the kind of file goes by its name's ending, .obj or .ply, in any case.
///
/// Polygons are fanned from their first corner. Triangles without area are kept (samples_at_vertices copes with them).
/// Throws FileError: unreadable, empty, truncated or malformed files, indices out of range, positions that are not
/// finite and used by a face, files without a face, other endings. Unused positions that are not finite are set to 0
/// with a notice. Throws std::length_error where the mesh would not fit in memory, and Stopped within 0.1 s of a stop
/// request.
[[nodiscard]] Mesh read_mesh(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
