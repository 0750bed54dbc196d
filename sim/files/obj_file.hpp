#pragma once

#include <stop_token>
#include <string>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads the triangles of an OBJ file, with the normals of its corners where every used vertex has some.
///
/// A vertex at which corners have different normals gets the sum of their unit vectors. Positions and normals may be
/// infinite or NaN: the caller decides about them. A backslash at the end of a line joins the next one to it, except in
/// comments. Lines of a kind that OBJ does not have are left out, with a notice.
///
/// Throws FileError with the line (the first of joined lines): malformed numbers or faces, indices out of range, a file
/// most of whose lines are of no kind that OBJ has; and as TextLines does. Throws std::length_error where the mesh
/// would not fit in memory, and Stopped.
[[nodiscard]] Mesh read_obj(const std::string& path, Notices& notices, std::stop_token stop = {});

}  // namespace detp::sim
