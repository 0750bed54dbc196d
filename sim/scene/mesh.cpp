#include "mesh.hpp"

#include <algorithm>
#include <cmath>

#include "vertices.hpp"

namespace detp::sim {

Box used_box(const Mesh& mesh) {
  Box box;
  for (const auto& corners : mesh.triangles)
    for (const std::uint32_t corner : corners) box.include(mesh.positions[corner]);
  return box;
}

double mean_edge_length(const Mesh& mesh, const std::stop_token& stop) {
  StopCheck check(stop, "measuring edges");
  const std::vector<std::uint32_t> place = first_of_place(mesh.positions, check);
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& [from, to] : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
      edges.push_back({std::min(place[from], place[to]), std::max(place[from], place[to])});
  std::sort(edges.begin(), edges.end(), [&](const auto& a, const auto& b) {
    check.after(1);
    return a < b;
  });
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  double sum = 0;
  std::size_t count = 0;
  for_each_checked(std::span(edges), check, [&](const auto& ends) {
    const glm::dvec3 edge = mesh.positions[ends[1]] - mesh.positions[ends[0]];
    if (edge == glm::dvec3{0.0}) return;  // the edge joins no two distinct positions
    sum += std::hypot(edge.x, edge.y, edge.z);
    ++count;
  });
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

}  // namespace detp::sim
