#pragma once

#include <array>
#include <utility>

#include "detp/sim/scene/coincident.hpp"

/// Meshes in the plane z = 0, and what becomes of meshes in which faces coincide.
namespace detp::support {

using sim::Mesh;
using Corner = std::array<double, 2>;

/// Adds the rectangle as `across` × `up` cells.
inline void add_rectangle(Mesh& mesh, const Corner& low, const Corner& high, std::uint32_t across = 1,
                          std::uint32_t up = 1) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t j = 0; j <= up; ++j)
    for (std::uint32_t i = 0; i <= across; ++i)
      mesh.positions.push_back({low[0] + (high[0] - low[0]) * i / across, low[1] + (high[1] - low[1]) * j / up, 0});
  for (std::uint32_t j = 0; j < up; ++j)
    for (std::uint32_t i = 0; i < across; ++i) {
      const std::uint32_t a = first + j * (across + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + across + 2});
      mesh.triangles.push_back({a, a + across + 2, a + across + 1});
    }
}

inline void turn_from(Mesh& mesh, std::size_t first) {
  for (std::size_t i = first; i < mesh.triangles.size(); ++i) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
}

inline double doubled_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  const auto& [a, b, c] = corners;
  return glm::length(glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

inline double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const auto& corners : mesh.triangles) sum += 0.5 * doubled_area(mesh, corners);
  return sum;
}

inline Mesh joined(Mesh mesh) {
  sim::Notices notices;
  sim::join_coincident(mesh, notices);
  return mesh;
}

inline bool same_bits(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles &&
         a.materials.of_triangle == b.materials.of_triangle && a.materials.of_back == b.materials.of_back &&
         a.groups.of_triangle == b.groups.of_triangle;
}

/// Leaves the mesh as it is, without a notice.
inline bool is_untouched(const Mesh& mesh) {
  Mesh after = mesh;
  sim::Notices notices;
  sim::join_coincident(after, notices);
  return same_bits(mesh, after) && notices.empty() && after.coincident == 0;
}

inline Mesh unit_square() {
  Mesh mesh;
  add_rectangle(mesh, {0, 0}, {1, 1});
  return mesh;
}

}  // namespace detp::support
