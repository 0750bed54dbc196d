#include "mesh_file.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "obj_file.hpp"
#include "ply.hpp"

namespace detp::sim {
namespace {

bool is_finite(const glm::dvec3& vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

std::uint32_t checked_index(const std::string& path, std::uint64_t face, double index, std::uint64_t vertices) {
  if (index >= 0 && index < static_cast<double>(vertices) && index <= UINT32_MAX && std::floor(index) == index)
    return static_cast<std::uint32_t>(index);
  throw FileError(path, "face " + std::to_string(face + 1) + ": index out of range; expected whole numbers from 0 to " +
                            std::to_string(vertices - 1));
}

/// The places of three properties in the element; empty if it lacks one of them.
std::vector<std::size_t> places_of(const PlyElement& element, const std::array<const char*, 3>& names) {
  std::vector<std::size_t> places;
  for (const char* name : names)
    if (const auto place = element.property(name, false)) places.push_back(*place);
  return places.size() == names.size() ? places : std::vector<std::size_t>{};
}

class PlyMeshReader {
 public:
  PlyMeshReader(const std::string& path, std::stop_token stop)
      : path_(path), file_(path, std::move(stop)), memory_(path) {}

  Mesh read() {
    std::vector<PlyRequest> requests{vertex_request()};
    if (const PlyElement* face = file_.element("face")) requests.push_back(face_request(*face));
    file_.read(requests);
    return std::move(mesh_);
  }

 private:
  PlyRequest vertex_request() {
    const PlyElement* vertex = file_.element("vertex");
    if (vertex != nullptr) vertices_ = vertex->rows;
    PlyRequest request{.element = "vertex", .properties = {}, .on_row = {}};
    if (vertices_ > 0) request.properties = places_of(*vertex, {"x", "y", "z"});
    if (request.properties.empty())
      throw FileError(path_, "has no element vertex with the properties x, y and z, or no vertex");
    const std::vector<std::size_t> normal = places_of(*vertex, {"nx", "ny", "nz"});
    request.properties.insert(request.properties.end(), normal.begin(), normal.end());
    request.on_row = [this, has_normals = !normal.empty()](std::uint64_t row, const PlyValues& values) {
      if (row == 0) memory_.reserve(mesh_.positions, vertices_);
      if (row == 0 && has_normals) memory_.reserve(mesh_.normals, vertices_);
      memory_.push(mesh_.positions, {values[0][0], values[1][0], values[2][0]});
      if (has_normals) memory_.push(mesh_.normals, {values[3][0], values[4][0], values[5][0]});
    };
    return request;
  }

  PlyRequest face_request(const PlyElement& face) {
    for (const char* name : {"vertex_indices", "vertex_index"})
      if (const auto place = face.property(name, true))
        return {.element = "face",
                .properties = {*place},
                .on_row = [this](std::uint64_t row, const PlyValues& values) { add_face(row, values[0]); }};
    throw FileError(path_, "its element face has no list vertex_indices");
  }

  void add_face(std::uint64_t face, const std::vector<double>& corners) {
    if (corners.size() < 3) throw FileError(path_, "face " + std::to_string(face + 1) + ": needs at least 3 corners");
    const auto corner = [&](std::size_t i) { return checked_index(path_, face, corners[i], vertices_); };
    for (std::size_t i = 2; i < corners.size(); ++i)
      memory_.push(mesh_.triangles, {corner(0), corner(i - 1), corner(i)});
  }

  const std::string& path_;
  PlyFile file_;
  KeptMemory memory_;
  Mesh mesh_;
  std::uint64_t vertices_ = 0;  ///< number of vertices that the header declares
};

/// Throws FileError if a vector that a face uses is not finite.
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

Mesh read_mesh(const std::string& path, Notices& notices, std::stop_token stop) {
  const bool is_ply = has_ending(path, ".ply");
  if (!is_ply && !has_ending(path, ".obj"))
    throw FileError(path, "is not a mesh file: its name must end in .obj or .ply");
  Mesh mesh = is_ply ? PlyMeshReader(path, std::move(stop)).read() : read_obj(path, notices, std::move(stop));
  if (mesh.triangles.empty()) throw FileError(path, "has no faces; a mesh needs at least one");
  check_used(mesh, mesh.positions, path, "position");
  if (!mesh.normals.empty()) check_used(mesh, mesh.normals, path, "normal");
  if (const std::size_t count = reset_not_finite(mesh.positions))
    notices.push_back("unused positions that are not finite, set to 0: " + std::to_string(count));
  reset_not_finite(mesh.normals);
  return mesh;
}

}  // namespace detp::sim
