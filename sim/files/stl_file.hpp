#pragma once

#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads the triangles of an STL file, binary or text. Each corner is a vertex. Normals of facets are not read: many programs
/// write zeros there. Each `solid` of a text file is a group with its name.
///
/// Throws FileError with the line (text) or the triangle (binary) if the file is malformed, or ends early; as TextLines does; std::length_error
/// if the mesh would not fit in memory, and Stopped.
[[nodiscard]] Mesh read_stl(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
