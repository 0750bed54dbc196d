#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "detp/sim/scene/mesh.hpp"

/// The pieces that the built-in scenes are made of. Each piece adds its own vertices to a mesh; pieces share none.
/// `cell` is the side of the squares that are cut into two triangles each, a length. It is rounded so that a whole
/// number of cells fills the piece.
namespace detp::sim::built_in {

struct Cells {
  int u;
  int v;
};

/// Number of cells of about that size along the length, at least 1.
[[nodiscard]] int cells_along(double length, double cell);

/// Adds the surface point(u, v) for (u, v) in [0, 1]². Its normals point along ∂u × ∂v.
void add_patch(Mesh& mesh, Cells cells, const std::function<glm::dvec3(double u, double v)>& point);

/// Adds the bilinear patch between four corners, listed counter-clockwise as seen from the patch's front.
void add_quad(Mesh& mesh, const std::array<glm::dvec3, 4>& corners, double cell);

/// Adds a box with this corner and the right-handed edges that start there. All six faces look outwards.
void add_box(Mesh& mesh, const glm::dvec3& corner, const std::array<glm::dvec3, 3>& edges, double cell);

/// Adds a sphere that looks outwards: the six faces of a cube, blown up, each of `cells` squares along a side.
void add_ball(Mesh& mesh, const glm::dvec3& centre, double radius, int cells);

/// Gives the material to all triangles that have none yet.
inline void paint(Mesh& mesh, std::uint16_t material) {
  mesh.materials.of_triangle.resize(mesh.triangles.size(), material);
}

/// A tube around a path, with `sides` >= 3 vertices in each ring. Its ends are open, but a pointed tip closes the last
/// one if `tip` is set.
struct Tube {
  std::span<const glm::dvec3> path;  ///< at least 2 points, all distinct
  std::span<const double> radii;     ///< one for each point of the path
  int sides = 3;
  bool tip = false;
};
void add_tube(Mesh& mesh, const Tube& tube);

}  // namespace detp::sim::built_in
