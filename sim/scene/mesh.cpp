#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/unit_vector.hpp"

namespace detp::sim {
namespace {

/// If the cross product of two edges is below this share of the product of their lengths, it is rounding error: the
/// triangle has no area.
constexpr double least_area = 8 * std::numeric_limits<double>::epsilon();

/// If a sum of area vectors is shorter than this share of their summed lengths, it is a residue of cancellation.
constexpr double least_sum = 1e-12;

std::vector<bool> used_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) used[corner] = true;
  return used;
}

/// The exponent of a power of two that scales the largest used coordinate to about 1. Then areas can neither vanish nor
/// overflow, and the scaling is exact.
int scale_exponent(const Mesh& mesh) {
  double largest = 0;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(mesh.positions[corner][axis]));
  return largest == 0 ? 0 : -std::ilogb(largest);
}

glm::dvec3 scaled(const glm::dvec3& point, int exponent) {
  return {std::scalbn(point.x, exponent), std::scalbn(point.y, exponent), std::scalbn(point.z, exponent)};
}

/// Twice the triangle's area times its unit normal; zero if it has no area. Computed at the corner between the two
/// shorter edges, where the rounding error is least.
glm::dvec3 area_vector(const std::array<glm::dvec3, 3>& corners) {
  const std::array edges{corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (glm::dot(edges[i], edges[i]) > glm::dot(edges[longest], edges[longest])) longest = i;
  const glm::dvec3& first = edges[(longest + 1) % 3];
  const glm::dvec3& second = edges[(longest + 2) % 3];
  const glm::dvec3 vector = glm::cross(first, second);
  return glm::length(vector) > least_area * glm::length(first) * glm::length(second) ? vector : glm::dvec3{0.0};
}

/// Adds up the area vectors of the triangles around a vertex.
struct AreaVectorSum {
  glm::dvec3 sum{0.0};
  glm::dvec3 largest{0.0};
  double area = 0;

  void add(const glm::dvec3& vector) {
    const double length = glm::length(vector);
    sum += vector;
    area += length;
    if (length > glm::length(largest)) largest = vector;
  }

  /// The vertex's normal: of unit length, or zero if no triangle has an area. If the area vectors cancel, for instance
  /// those of a leaf with one triangle for each side, it is the normal of the largest triangle.
  [[nodiscard]] glm::dvec3 normal() const { return unit_or_zero(glm::length(sum) > least_sum * area ? sum : largest); }
};

std::vector<glm::dvec3> normals_by_area(const Mesh& mesh, StopCheck& check) {
  std::vector<AreaVectorSum> sums(mesh.positions.size());
  const int exponent = scale_exponent(mesh);
  for_each_checked(std::span(mesh.triangles), check, [&](const auto& corners) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 vector = area_vector({scaled(mesh.positions[a], exponent), scaled(mesh.positions[b], exponent),
                                           scaled(mesh.positions[c], exponent)});
    for (const std::uint32_t corner : {a, b, c}) sums[corner].add(vector);
  });
  std::vector<glm::dvec3> normals;
  normals.reserve(sums.size());
  for_each_checked(std::span(sums), check, [&](const AreaVectorSum& sum) { normals.push_back(sum.normal()); });
  return normals;
}

/// Those of the mesh, in place of a zero one that of the triangles around.
std::vector<glm::dvec3> normals_given(const Mesh& mesh, StopCheck& check) {
  std::vector<glm::dvec3> normals;
  normals.reserve(mesh.normals.size());
  bool some_zero = false;
  for_each_checked(std::span(mesh.normals), check, [&](const glm::dvec3& normal) {
    normals.push_back(unit_or_zero(normal));
    some_zero = some_zero || normals.back() == glm::dvec3{0.0};
  });
  if (!some_zero) return normals;
  const std::vector<glm::dvec3> others = normals_by_area(mesh, check);
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (normals[i] == glm::dvec3{0.0}) normals[i] = others[i];
  return normals;
}

void note_dropped(Notices& notices, std::size_t count, const std::string& kind, const std::string& why = "") {
  if (count > 0)
    notices.push_back(std::to_string(count) + kind + (count == 1 ? " vertex" : " vertices") + " dropped" + why);
}

}  // namespace

std::vector<Sample> samples_at_vertices(const Mesh& mesh, Notices& notices, const std::stop_token& stop) {
  StopCheck check(stop, "taking samples at the vertices");
  const std::vector<glm::dvec3> normals =
      mesh.normals.empty() ? normals_by_area(mesh, check) : normals_given(mesh, check);
  const std::vector<bool> used = used_vertices(mesh);
  std::vector<Sample> samples;
  samples.reserve(mesh.positions.size());
  std::size_t unreferenced = 0;
  std::size_t without_normal = 0;
  for_each_checked(0, mesh.positions.size(), check, [&](std::size_t i) {
    if (!used[i])
      ++unreferenced;
    else if (normals[i] == glm::dvec3{0.0})
      ++without_normal;
    else
      samples.push_back({.position = mesh.positions[i], .normal = normals[i]});
  });
  note_dropped(notices, unreferenced, " unreferenced");
  note_dropped(notices, without_normal, "", ": no triangle around has an area");
  return samples;
}

double mean_edge_length(const Mesh& mesh, const std::stop_token& stop) {
  StopCheck check(stop, "measuring edges");
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    for (const auto& [from, to] : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
      edges.push_back({std::min(from, to), std::max(from, to)});
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
