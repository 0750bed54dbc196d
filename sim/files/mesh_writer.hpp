#pragma once

#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Writes a mesh as binary little-endian PLY: positions (and normals where it has them) as doubles, so that read_mesh
/// gives back the same mesh. Throws FileError where it cannot be written.
void write_ply(const std::string& path, const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
