#pragma once

#include <string>

#include "mesh.hpp"

namespace detp::sim {

/// Reads the triangles of an OBJ file, with the normals of its corners where every used vertex has some.
///
/// A vertex at which corners have different normals gets the sum of their unit vectors. Positions and normals may be
/// infinite or NaN: the caller decides about them. Throws FileError with the line: malformed numbers or faces, indices
/// out of range.
[[nodiscard]] Mesh read_obj(const std::string& path);

}  // namespace detp::sim
