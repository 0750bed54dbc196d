#include "mesh_writer.hpp"

#include <fmt/format.h>

#include "output_file.hpp"
#include "ply_bytes.hpp"
#include "writing_check.hpp"

namespace detp::sim {
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
