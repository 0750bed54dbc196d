#include "disc_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <utility>

#include "detp/sim/estimate/face_sums.hpp"

namespace detp::validate {

std::vector<std::array<std::uint32_t, 3>> triangles_of_discs(const Job& job) {
  if (!job.scene || job.vertices.size() != job.discs.size()) return {};
  const sim::Mesh& mesh = job.scene->mesh;
  std::unordered_multimap<std::uint32_t, std::uint32_t> discs_at;
  for (std::uint32_t disc = 0; disc < job.vertices.size(); ++disc) discs_at.emplace(job.vertices[disc], disc);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const auto& corners = mesh.triangles[triangle];
    const glm::dvec3 normal = sim::area_vector(mesh, triangle);
    std::array<std::uint32_t, 3>& own = triangles.emplace_back();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t vertex = mesh.file_vertices.empty() ? corners[i] : mesh.file_vertices[corners[i]];
      const auto [first, last] = discs_at.equal_range(vertex);
      if (first == last) return {};
      own[i] = std::max_element(first, last, [&](const auto& one, const auto& other) {
                 const auto nearness = [&](std::uint32_t disc) { return glm::dot(job.discs[disc].normal, normal); };
                 return std::pair(nearness(one.second), other.second) < std::pair(nearness(other.second), one.second);
               })->second;
    }
  }
  return triangles;
}

DiscPolygons polygons_of(std::span<const sim::Disc> discs) {
  constexpr double most_triangles = 2e6;
  constexpr double pi = 3.14159265358979323846;
  const double corners =
      std::clamp(most_triangles / static_cast<double>(std::max<std::size_t>(1, discs.size())) + 2, 4.0, 18.0);
  DiscPolygons polygons{{}, static_cast<std::uint32_t>(corners) - 2};
  const std::uint32_t count = polygons.triangles_each + 2;
  // Of the disc's area.
  const double stretch = std::sqrt(2 * pi / count / std::sin(2 * pi / count));
  for (const sim::Disc& disc : discs) {
    const glm::dvec3 across = std::abs(disc.normal.x) < 0.6 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0};
    const glm::dvec3 first = disc.radius * stretch * glm::normalize(glm::cross(disc.normal, across));
    const glm::dvec3 second = glm::cross(disc.normal, first);
    const auto begin = static_cast<std::uint32_t>(polygons.mesh.positions.size());
    for (std::uint32_t i = 0; i < count; ++i)
      polygons.mesh.positions.push_back(disc.centre + std::cos(2 * pi * i / count) * first +
                                        std::sin(2 * pi * i / count) * second);
    for (std::uint32_t i = 0; i < polygons.triangles_each; ++i)
      polygons.mesh.triangles.push_back({begin, begin + i + 1, begin + i + 2});
  }
  return polygons;
}

}  // namespace detp::validate
