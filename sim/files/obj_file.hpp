#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// Reads the triangles of an OBJ file (polygon.hpp: those of its polygons), and the normals of its corners.
///
/// A vertex whose corners have different normals gets the sum of their unit vectors; one whose normals are missing, zero or not
/// finite gets 0. A face is in the object of the last `o` and in the groups of the last `g` (Mesh::groups); a `g` alone names
/// "default". Positions may be infinite or NaN: the caller decides about them. Faces may come before their vertices. A # after a
/// blank begins a comment, unless the name of a material or file has it. A backslash at the end of a line joins the next line to this line,
/// except in comments. Lines with a keyword unknown to OBJ are skipped, with a notice.
///
/// Throws FileError with the line (the first of joined lines) if a number or face is malformed, an index is out of
/// range, a face is in more than 100 groups, or lines with unknown keywords outnumber the other statements by more than
/// 100; and as TextLines does. Throws std::length_error if the mesh would not fit in memory, and Stopped.
[[nodiscard]] Mesh read_obj(const std::string& path, Notices& notices, std::stop_token stop = {});

/// Paths of the material libraries that an OBJ file names, in its order, each once; there may be no file there. Throws as read_obj
/// does, but does not look at numbers and faces.
[[nodiscard]] std::vector<std::string> material_files(const std::string& path, std::stop_token stop = {});

}  // namespace detp::sim
