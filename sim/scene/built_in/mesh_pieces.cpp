#include "mesh_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "detp/sim/geometry/directions.hpp"

namespace detp::sim::built_in {
namespace {

std::uint32_t next_vertex(const Mesh& mesh) { return static_cast<std::uint32_t>(mesh.positions.size()); }

glm::dvec3 path_direction(std::span<const glm::dvec3> path, std::size_t i) {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = std::min(i + 1, path.size() - 1);
  return glm::normalize(path[after] - path[before]);
}

void add_ring(Mesh& mesh, const glm::dvec3& centre, const glm::dvec3& first, const glm::dvec3& second, double radius,
              int sides) {
  for (int side = 0; side < sides; ++side) {
    const double angle = 2 * std::numbers::pi * side / sides;
    mesh.positions.push_back(centre + radius * (std::cos(angle) * first + std::sin(angle) * second));
  }
}

}  // namespace

int cells_along(double length, double cell) { return std::max(1, static_cast<int>(std::lround(length / cell))); }

void add_patch(Mesh& mesh, Cells cells, const std::function<glm::dvec3(double, double)>& point) {
  const std::uint32_t base = next_vertex(mesh);
  const std::uint32_t row = static_cast<std::uint32_t>(cells.u) + 1;
  for (int j = 0; j <= cells.v; ++j)
    for (int i = 0; i <= cells.u; ++i)
      mesh.positions.push_back(point(static_cast<double>(i) / cells.u, static_cast<double>(j) / cells.v));
  for (int j = 0; j < cells.v; ++j)
    for (int i = 0; i < cells.u; ++i) {
      const std::uint32_t a = base + static_cast<std::uint32_t>(j) * row + static_cast<std::uint32_t>(i);
      mesh.triangles.push_back({a, a + 1, a + row + 1});
      mesh.triangles.push_back({a, a + row + 1, a + row});
    }
}

void add_quad(Mesh& mesh, const std::array<glm::dvec3, 4>& corners, double cell) {
  const auto& [a, b, c, d] = corners;
  const double along_u = 0.5 * (glm::length(b - a) + glm::length(c - d));
  const double along_v = 0.5 * (glm::length(d - a) + glm::length(c - b));
  add_patch(mesh, {cells_along(along_u, cell), cells_along(along_v, cell)}, [&corners](double u, double v) {
    return (1 - v) * ((1 - u) * corners[0] + u * corners[1]) + v * ((1 - u) * corners[3] + u * corners[2]);
  });
}

void add_box(Mesh& mesh, const glm::dvec3& corner, const std::array<glm::dvec3, 3>& edges, double cell) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const glm::dvec3& across = edges[axis];
    const glm::dvec3& u = edges[(axis + 1) % 3];
    const glm::dvec3& v = edges[(axis + 2) % 3];
    const glm::dvec3 far = corner + across;
    add_quad(mesh, {corner, corner + v, corner + u + v, corner + u}, cell);
    add_quad(mesh, {far, far + u, far + u + v, far + v}, cell);
  }
}

void add_ball(Mesh& mesh, const glm::dvec3& centre, double radius, int cells) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      add_patch(mesh, {cells, cells}, [&](double u, double v) {
        glm::dvec3 point;
        point[axis] = sign;
        point[(axis + 1) % 3] = std::tan(std::numbers::pi / 4 * (2 * u - 1));
        point[(axis + 2) % 3] = sign * std::tan(std::numbers::pi / 4 * (2 * v - 1));
        return centre + radius * glm::normalize(point);
      });
}

void add_tube(Mesh& mesh, const Tube& tube) {
  const std::uint32_t base = next_vertex(mesh);
  const std::uint32_t sides = static_cast<std::uint32_t>(tube.sides);
  glm::dvec3 first = basis_around(path_direction(tube.path, 0))[0];
  for (std::size_t i = 0; i < tube.path.size(); ++i) {
    // Carries the frame along the path. A frame chosen independently at each point would twist the tube.
    const glm::dvec3 axis = path_direction(tube.path, i);
    first = glm::normalize(first - glm::dot(first, axis) * axis);
    add_ring(mesh, tube.path[i], first, glm::cross(axis, first), tube.radii[i], tube.sides);
  }
  const std::uint32_t rings = static_cast<std::uint32_t>(tube.path.size());
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = base + ring * sides + side;
      const std::uint32_t b = base + ring * sides + (side + 1) % sides;
      mesh.triangles.push_back({a, b, b + sides});
      mesh.triangles.push_back({a, b + sides, a + sides});
    }
  if (!tube.tip) return;
  const std::uint32_t apex = next_vertex(mesh);
  const std::uint32_t last = base + (rings - 1) * sides;
  mesh.positions.push_back(tube.path.back() + tube.radii.back() * path_direction(tube.path, tube.path.size() - 1));
  for (std::uint32_t side = 0; side < sides; ++side)
    mesh.triangles.push_back({last + side, last + (side + 1) % sides, apex});
}

}  // namespace detp::sim::built_in
