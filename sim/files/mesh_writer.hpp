#pragma once

#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Writes a mesh as binary little-endian PLY. Positions (and normals, if it has any) are doubles, so read_mesh returns
/// the same mesh. Throws FileError if the file cannot be written, and Stopped.
void write_ply(const std::string& path, const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
