#pragma once

#include <array>
#include <functional>
#include <span>

#include "detp/sim/scene/mesh.hpp"

/// The pieces that the built-in scenes are made of. Each is added to a mesh with vertices of its own, shared within the
/// piece. `cell` is the side of the squares that are cut into two triangles each, a length; it is rounded so that whole
/// cells fill the piece.
namespace detp::sim::built_in {

struct Cells {
  int u;
  int v;
};

/// How many cells of about that size fill the length, at least 1.
[[nodiscard]] int cells_along(double length, double cell);

/// The surface point(u, v) for (u, v) in [0, 1]²; its normals point towards ∂u × ∂v.
void add_patch(Mesh& mesh, Cells cells, const std::function<glm::dvec3(double u, double v)>& point);

/// The bilinear patch between corners in order around it; seen from its front they run counter-clockwise.
void add_quad(Mesh& mesh, const std::array<glm::dvec3, 4>& corners, double cell);

/// A box given by one corner and three edges, a right-handed system; all six faces look outwards.
void add_box(Mesh& mesh, const glm::dvec3& corner, const std::array<glm::dvec3, 3>& edges, double cell);

/// A tube around a path, `sides` >= 3 vertices a ring, welded all round; with a pointed tip where `tip` is set.
struct Tube {
  std::span<const glm::dvec3> path;  ///< at least 2 points, all apart
  std::span<const double> radii;     ///< one for each point of the path
  int sides = 3;
  bool tip = false;
};
void add_tube(Mesh& mesh, const Tube& tube);

}  // namespace detp::sim::built_in
