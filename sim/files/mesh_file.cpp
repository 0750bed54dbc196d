#include "mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "file_error.hpp"
#include "gltf_file.hpp"
#include "input_file.hpp"
#include "obj_file.hpp"
#include "output_file.hpp"
#include "ply.hpp"
#include "polygon.hpp"
#include "stl_file.hpp"
#include "writing_check.hpp"

namespace detp::sim {
namespace {

bool is_finite(const glm::dvec3& vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

std::uint32_t checked_index(const std::string& path, const char* what, std::uint64_t number, double index,
                            std::uint64_t vertices) {
  if (index >= 0 && index < static_cast<double>(vertices) && index <= UINT32_MAX && std::floor(index) == index)
    return static_cast<std::uint32_t>(index);
  throw FileError(path, std::string(what) + " " + std::to_string(number + 1) +
                            ": index out of range; expected whole numbers from 0 to " + std::to_string(vertices - 1));
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
      : path_(path), file_(path, stop), memory_(path), check_(std::move(stop), "reading polygons") {}

  Mesh read() {
    std::vector<PlyRequest> requests{vertex_request()};
    const PlyElement* strips = file_.element("tristrips");
    if (strips != nullptr) requests.push_back(list_request(*strips, &PlyMeshReader::add_strip));
    if (const PlyElement* face = file_.element("face"); face != nullptr && (face->rows > 0 || strips == nullptr))
      requests.push_back(list_request(*face, &PlyMeshReader::add_face));
    file_.read(requests);
    for (auto& [face, corners] : late_) divide(face, corners);
    mesh_.polygons = triangulator_.counts();
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

  using AddRow = void (PlyMeshReader::*)(std::uint64_t, const std::vector<double>&);

  PlyRequest list_request(const PlyElement& element, AddRow add) {
    for (const char* name : {"vertex_indices", "vertex_index"})
      if (const auto place = element.property(name, true))
        return {.element = element.name,
                .properties = {*place},
                .on_row = [this, add](std::uint64_t row, const PlyValues& values) { (this->*add)(row, values[0]); }};
    throw FileError(path_, "its element " + element.name + " has no list vertex_indices");
  }

  void add_face(std::uint64_t face, const std::vector<double>& corners) {
    if (corners.size() < 3) throw FileError(path_, "face " + std::to_string(face + 1) + ": needs at least 3 corners");
    polygon_.clear();
    for (const double one : corners) polygon_.push_back(checked_index(path_, "face", face, one, vertices_));
    if (mesh_.positions.size() == vertices_)
      divide(face, polygon_);
    else
      late_.emplace_back(face, polygon_);
  }

  /// Each corner makes a triangle with the two before it, of alternating orientation; -1 begins anew.
  void add_strip(std::uint64_t strip, const std::vector<double>& corners) {
    std::size_t length = 0;
    std::array<std::uint32_t, 3> last{};
    for (const double one : corners) {
      length = one == -1 ? 0 : length + 1;
      if (length == 0) continue;
      last = {last[1], last[2], checked_index(path_, "strip", strip, one, vertices_)};
      const auto& [a, b, c] = last;
      if (length < 3 || a == b || b == c || c == a) continue;  // a strip turns by corners that are repeated
      memory_.push(mesh_.triangles, length % 2 == 1 ? last : std::array{b, a, c});
    }
  }

  void divide(std::uint64_t face, std::vector<std::uint32_t>& polygon) {
    drop_repeated_corners(polygon);
    if (polygon.size() < 3) throw FileError(path_, "face " + std::to_string(face + 1) + ": needs at least 3 corners");
    for (const auto& triangle : triangulator_.triangles_of(polygon, mesh_.positions, check_))
      memory_.push(mesh_.triangles, triangle);
  }

  const std::string& path_;
  PlyFile file_;
  KeptMemory memory_;
  Mesh mesh_;
  std::uint64_t vertices_ = 0;  ///< number of vertices that the header declares
  Triangulator triangulator_;
  StopCheck check_;
  std::vector<std::uint32_t> polygon_;
  std::vector<std::pair<std::uint64_t, std::vector<std::uint32_t>>>
      late_;  ///< faces before the vertices, and their numbers
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

/// Sets normals that are not finite to 0, for which others are made, and counts the corners with such.
void reset_normals(Mesh& mesh) {
  if (mesh.normals.empty()) return;
  reset_not_finite(mesh.normals);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) mesh.normals_made += mesh.normals[corner] == glm::dvec3{0.0} ? 1 : 0;
}

void note_geometry(const Mesh& mesh, Notices& notices) {
  const auto note = [&](std::uint64_t count, const char* what) {
    if (count > 0) notices.push_back(fmt::format("{}: {}", what, count));
  };
  note(mesh.polygons.degenerate, "faces without area, or that cross themselves");
  note(mesh.normals_made, "corners whose normal is missing, zero or not finite, with that of the faces around");
}

Mesh read_ply_mesh(const std::string& path, Notices&, std::stop_token stop) {
  Mesh mesh = PlyMeshReader(path, std::move(stop)).read();
  reset_normals(mesh);
  return mesh;
}

Mesh read_gltf_mesh(const std::string& path, Notices& notices, std::stop_token stop) {
  Mesh mesh = read_gltf(path, notices, std::move(stop));
  reset_normals(mesh);
  return mesh;
}

/// What a name's ending says about the file. A new format is a line here, and a file with what reads it.
struct MeshFormat {
  std::string_view suffix;
  Mesh (*read)(const std::string& path, Notices& notices, std::stop_token stop);
};
constexpr std::array formats{MeshFormat{".obj", read_obj}, MeshFormat{".ply", read_ply_mesh},
                             MeshFormat{".stl", read_stl}, MeshFormat{".gltf", read_gltf_mesh},
                             MeshFormat{".glb", read_gltf_mesh}};

}  // namespace

std::string mesh_suffixes() {
  std::string all;
  for (const MeshFormat& one : formats)
    all += fmt::format("{}{}", all.empty() ? "" : &one == &formats.back() ? " or " : ", ", one.suffix);
  return all;
}

std::vector<std::string> files_of_mesh(const std::string& path, std::stop_token stop) {
  if (has_ending(without_gz(path), ".obj")) return material_files(path, std::move(stop));
  if (has_ending(path, ".gltf")) return gltf_buffers(path, std::move(stop));
  return {};
}

Mesh read_mesh(const std::string& path, Notices& notices, std::stop_token stop) {
  const auto* format =
      std::ranges::find_if(formats, [&](const auto& one) { return has_ending(without_gz(path), one.suffix); });
  if (format == formats.end())
    throw FileError(path, fmt::format("is not a mesh file: its name must end in {}", mesh_suffixes()));
  Mesh mesh = format->read(path, notices, std::move(stop));
  if (mesh.triangles.empty()) throw FileError(path, "has no faces; a mesh needs at least one");
  check_used(mesh, mesh.positions, path, "position");
  if (const std::size_t count = reset_not_finite(mesh.positions))
    notices.push_back("unused positions that are not finite, set to 0: " + std::to_string(count));
  note_geometry(mesh, notices);
  return mesh;
}

namespace {

void write_vector(OutputFile& file, const glm::dvec3& vector) {
  for (int axis = 0; axis < 3; ++axis) write_little_endian(file, vector[axis]);
}

void write_header(OutputFile& file, const Mesh& mesh) {
  file.write(fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.size()));
  file.write("property double x\nproperty double y\nproperty double z\n");
  if (!mesh.normals.empty()) file.write("property double nx\nproperty double ny\nproperty double nz\n");
  file.write(
      fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size()));
}

}  // namespace

void write_ply(const std::string& path, const Mesh& mesh, const std::stop_token& stop) {
  WritingCheck check(path, mesh.positions.size() + mesh.triangles.size(), "vertices and triangles", stop);
  OutputFile file(path, stop);
  write_header(file, mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    check.next();
    write_vector(file, mesh.positions[i]);
    if (!mesh.normals.empty()) write_vector(file, mesh.normals[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    check.next();
    write_little_endian(file, std::uint8_t{3});
    for (const std::uint32_t corner : triangle) write_little_endian(file, static_cast<std::int32_t>(corner));
  }
  file.commit();
}

}  // namespace detp::sim
