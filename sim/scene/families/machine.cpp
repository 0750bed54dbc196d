#include <array>
#include <numbers>

#include "draw.hpp"
#include "families.hpp"

namespace detp::sim::families {
namespace {

constexpr int sides = 12;

int steps_for(double length, double cell) { return std::max(2, cells_along(length, cell)); }

/// A tube with a flat disc of triangles at both ends.
void add_shaft(Mesh& mesh, const glm::dvec3& from, const glm::dvec3& to, double radius, double cell) {
  const int steps = steps_for(glm::distance(from, to), cell);
  std::vector<glm::dvec3> path;
  for (int i = 0; i <= steps; ++i) path.push_back(from + (to - from) * (static_cast<double>(i) / steps));
  add_tube(mesh, {.path = path, .radii = std::vector(path.size(), radius), .sides = sides, .tip = true});
}

/// Straight pieces along the axes, joined at right angles.
void add_pipe(Mesh& mesh, Draw& draw, glm::dvec3 at, double reach, double radius, double cell) {
  std::vector<glm::dvec3> path{at};
  int last = -1;
  const int pieces = draw.whole(2, 7);
  for (int i = 0; i < pieces; ++i) {
    int axis = draw.whole(0, 2);
    if (axis == last) axis = (axis + 1) % 3;
    last = axis;
    const bool down = axis == 1 ? at.y > 0.5 * reach : draw.chance(0.5);
    const double length = draw.between(0.2, 0.7) * reach * (down ? -1 : 1);
    const int steps = steps_for(std::abs(length), cell);
    for (int step = 1; step <= steps; ++step) {
      path.push_back(at);
      path.back()[axis] += length * step / steps;
    }
    at = path.back();
  }
  add_tube(mesh, {.path = path, .radii = std::vector(path.size(), radius), .sides = sides});
}

}  // namespace

built_in::LitMesh machine(std::uint64_t seed) {
  Draw draw(seed, 3);
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_materials(mesh, draw, 3);
  const double w = draw.between(1, 4);
  const double d = draw.between(0.5, 1) * w;
  const double cell = draw.log_between(0.008, 0.04) * w;
  add_box(mesh, {0, -0.1, 0}, {{{w, 0, 0}, {0, 0.1, 0}, {0, 0, d}}}, 2 * cell);
  paint(mesh, 0);
  const int parts = draw.whole(4, 24);
  for (int i = 0; i < parts; ++i) {
    const glm::dvec3 at = draw.in({0.05 * w, 0, 0.05 * d}, {0.85 * w, 0.3 * w, 0.85 * d});
    const double size = draw.log_between(0.02, 0.25) * w;
    const int kind = draw.whole(0, 3);
    if (kind == 0) add_box(mesh, {at.x, 0, at.z}, {{{size, 0, 0}, {0, at.y + 0.01 * w, 0}, {0, 0, size}}}, cell);
    if (kind == 1) {
      const double turn = draw.between(0, 2 * std::numbers::pi);
      add_shaft(mesh, at, at + 2 * size * glm::dvec3{std::cos(turn), 0.2, std::sin(turn)}, 0.2 * size, cell);
    }
    if (kind == 2) add_ball(mesh, at, 0.4 * size, std::clamp(cells_along(0.6 * size, cell), 2, 40));
    if (kind == 3) add_pipe(mesh, draw, at, 0.3 * w, 0.08 * size, cell);
    paint(mesh, static_cast<std::uint16_t>(1 + i % 2));
  }
  const int lamps = draw.whole(1, 3);
  for (int i = 0; i < lamps; ++i) {
    const glm::dvec3 place = draw.in({0, 0.6 * w, 0}, {w, 1.2 * w, d});
    if (draw.chance(0.5))
      lit_mesh.lights.push_back({PointLight{place}, draw.between(0.2, 1)});
    else
      lit_mesh.lights.push_back(
          {SpotLight{place, glm::dvec3{0.5 * w, 0, 0.5 * d} - place, draw.between(0.2, 0.8)}, draw.between(0.2, 1)});
  }
  return lit_mesh;
}

}  // namespace detp::sim::families
