#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/scene/mesh.hpp"

namespace detp::sim {

/// The endings of the names of mesh files, as in ".obj or .ply".
[[nodiscard]] std::string mesh_suffixes();

/// Paths of the other files that a mesh file names, as materials and buffers; there may be no file there. Throws FileError.
[[nodiscard]] std::vector<std::string> files_of_mesh(const std::string& path, std::stop_token stop = {});

/// Reads a triangle mesh. The ending of the file's name, in upper or lower case, decides the format.
///
/// Polygons are divided as Triangulator does. Triangles without area are kept. A position with several normals becomes a vertex for
/// each of them (Mesh::file_vertices). Positions that are not finite are set to 0 if no face uses them; normals that are not, or are
/// zero or missing, are 0 and counted (Mesh::normals_made), if others are there. Each kind adds a notice with its count.
///
/// Throws FileError for unreadable, empty, truncated or malformed files, indices out of range, files without a face,
/// names with other endings, and if a face uses a position that is not finite. Throws std::length_error if
/// the mesh would not fit in memory, and Stopped within 0.1 s of a stop request.
[[nodiscard]] Mesh read_mesh(const std::string& path, Notices& notices, std::stop_token stop = {});

/// Writes a mesh as binary little-endian PLY. Positions (and normals, if it has any) are doubles, so read_mesh returns
/// the same mesh. Throws FileError if the file cannot be written, and Stopped.
void write_ply(const std::string& path, const Mesh& mesh, const std::stop_token& stop = {});

}  // namespace detp::sim
