#include "mesh_file.hpp"

#include <cmath>

#include "file_error.hpp"
#include "input_file.hpp"
#include "obj_file.hpp"
#include "ply.hpp"

namespace detp::sim {
namespace {

bool is_finite(const glm::dvec3& vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

/// Three columns as vectors; none where the file lacks one of them.
std::vector<glm::dvec3> vectors(const PlyRows& rows, const std::array<const char*, 3>& names) {
  std::array<const PlyColumn*, 3> columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    columns[axis] = rows.column(names[axis]);
    if (columns[axis] == nullptr) return {};
  }
  std::vector<glm::dvec3> result;
  result.reserve(rows.rows);
  for (std::size_t i = 0; i < rows.rows; ++i)
    result.emplace_back(columns[0]->values[i], columns[1]->values[i], columns[2]->values[i]);
  return result;
}

std::uint32_t checked_index(const std::string& path, std::size_t face, double index, std::size_t vertices) {
  if (index >= 0 && index < static_cast<double>(vertices) && index <= UINT32_MAX && std::floor(index) == index)
    return static_cast<std::uint32_t>(index);
  throw FileError(path, "face " + std::to_string(face + 1) +
                            ": index out of range; wanted are whole numbers from 0 to " + std::to_string(vertices - 1));
}

void add_faces(Mesh& mesh, const std::string& path, const PlyColumn& lists) {
  std::size_t begin = 0;
  for (std::size_t face = 0; face < lists.ends.size(); ++face) {
    const std::size_t end = lists.ends[face];
    if (end - begin < 3) throw FileError(path, "face " + std::to_string(face + 1) + ": needs at least 3 corners");
    const auto corner = [&](std::size_t i) {
      return checked_index(path, face, lists.values[i], mesh.positions.size());
    };
    for (std::size_t i = begin + 2; i < end; ++i) mesh.triangles.push_back({corner(begin), corner(i - 1), corner(i)});
    begin = end;
  }
}

Mesh read_ply_mesh(const std::string& path) {
  const auto elements =
      read_ply(path, {{"vertex", {"x", "y", "z", "nx", "ny", "nz"}}, {"face", {"vertex_indices", "vertex_index"}}});
  Mesh mesh;
  if (const auto vertex = elements.find("vertex"); vertex != elements.end()) {
    mesh.positions = vectors(vertex->second, {"x", "y", "z"});
    mesh.normals = vectors(vertex->second, {"nx", "ny", "nz"});
  }
  if (mesh.positions.empty()) throw FileError(path, "has no element vertex with the properties x, y and z");
  const auto face = elements.find("face");
  if (face == elements.end()) return mesh;
  for (const char* name : {"vertex_indices", "vertex_index"})
    if (const PlyColumn* lists = face->second.column(name, true)) {
      add_faces(mesh, path, *lists);
      return mesh;
    }
  throw FileError(path, "its element face has no list vertex_indices");
}

/// Refuses vectors that are not finite and that a face uses.
void check_used(const Mesh& mesh, const std::vector<glm::dvec3>& vectors, const std::string& path,
                const std::string& what) {
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      if (!is_finite(vectors[corner]))
        throw FileError(path, "vertex " + std::to_string(corner + std::uint64_t{1}) +
                                  " (counting from 1) is used by a face, but its " + what + " is not finite");
}

std::size_t reset_not_finite(std::vector<glm::dvec3>& vectors) {
  std::size_t count = 0;
  for (glm::dvec3& vector : vectors)
    if (!is_finite(vector)) {
      vector = glm::dvec3{0.0};
      ++count;
    }
  return count;
}

}  // namespace

Mesh read_mesh(const std::string& path, Notices& notices) {
  const bool is_ply = has_ending(path, ".ply");
  if (!is_ply && !has_ending(path, ".obj")) throw FileError(path, "is no mesh file: its name must end in .obj or .ply");
  Mesh mesh = is_ply ? read_ply_mesh(path) : read_obj(path);
  if (mesh.triangles.empty()) throw FileError(path, "has no faces; a mesh needs at least one");
  check_used(mesh, mesh.positions, path, "position");
  if (!mesh.normals.empty()) check_used(mesh, mesh.normals, path, "normal");
  if (const std::size_t count = reset_not_finite(mesh.positions))
    notices.push_back("unused positions that are not finite, set to 0: " + std::to_string(count));
  reset_not_finite(mesh.normals);
  return mesh;
}

}  // namespace detp::sim
