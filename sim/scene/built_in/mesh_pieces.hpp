#pragma once

#include <array>
#include <functional>
#include <span>

#include "detp/sim/scene/mesh.hpp"

/// The pieces that the built-in scenes are made of. Each piece added to a mesh brings its own vertices, which only its
/// own triangles share. `cell` is a length: the side of the squares that are cut into two triangles each. It is rounded
/// so that a whole number of cells fills the piece.
namespace detp::sim::built_in {

struct Cells {
  int u;
  int v;
};

/// Number of cells of about that size along the length, at least 1.
[[nodiscard]] int cells_along(double length, double cell);

/// Adds the surface point(u, v) for (u, v) in [0, 1]². Its normals point along ∂u × ∂v.
void add_patch(Mesh& mesh, Cells cells, const std::function<glm::dvec3(double u, double v)>& point);

/// Adds the bilinear patch between four corners, listed in order around it. Seen from its front they run
/// counter-clockwise.
void add_quad(Mesh& mesh, const std::array<glm::dvec3, 4>& corners, double cell);

/// Adds a box that starts at a corner and has three edges, a right-handed system. All six faces look outwards.
void add_box(Mesh& mesh, const glm::dvec3& corner, const std::array<glm::dvec3, 3>& edges, double cell);

/// A tube around a path with `sides` >= 3 vertices a ring, closed all round. It has a pointed tip if `tip` is set.
struct Tube {
  std::span<const glm::dvec3> path;  ///< at least 2 points, all distinct
  std::span<const double> radii;     ///< one for each point of the path
  int sides = 3;
  bool tip = false;
};
void add_tube(Mesh& mesh, const Tube& tube);

}  // namespace detp::sim::built_in
