#include "detp/sim/scene/built_in/wall.hpp"
#include "draw.hpp"
#include "families.hpp"

namespace detp::sim::families {
namespace {

/// A box that stands upright, turned about the vertical.
void add_block(Mesh& mesh, const glm::dvec3& corner, const glm::dvec3& size, double turn, double cell) {
  const glm::dvec3 along{std::cos(turn), 0, std::sin(turn)};
  const glm::dvec3 across{-std::sin(turn), 0, std::cos(turn)};
  add_box(mesh, corner, {{size.x * along, {0, size.y, 0}, size.z * across}}, cell);
}

/// A top on four legs.
void add_stand(Mesh& mesh, Draw& draw, const glm::dvec3& corner, double cell) {
  const glm::dvec3 size = draw.in({0.4, 0.4, 0.4}, {1.8, 0.9, 1});
  const double leg = draw.between(0.03, 0.08);
  for (const double x : {0.0, size.x - leg})
    for (const double z : {0.0, size.z - leg})
      add_block(mesh, corner + glm::dvec3{x, 0, z}, {leg, size.y, leg}, 0, cell);
  add_block(mesh, corner + glm::dvec3{0, size.y, 0}, {size.x, leg, size.z}, 0, cell);
}

/// Boards above each other.
void add_boards(Mesh& mesh, Draw& draw, const glm::dvec3& corner, double cell) {
  const glm::dvec3 size = draw.in({0.6, 0.02, 0.25}, {1.5, 0.04, 0.4});
  const int boards = draw.whole(2, 7);
  for (int i = 0; i < boards; ++i) add_block(mesh, corner + glm::dvec3{0, 0.1 + 0.32 * i, 0}, size, 0, cell);
}

}  // namespace

built_in::LitMesh room(std::uint64_t seed) {
  Draw draw(seed, 1);
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  const double w = draw.between(3, 9);
  const double d = draw.between(3, 9);
  const double h = draw.between(2.4, 4);
  const double coarse = draw.log_between(0.04, 0.25);
  const double fine = coarse * draw.log_between(0.2, 1);
  add_materials(mesh, draw, 3);
  add_quad(mesh, {{{0, 0, 0}, {0, 0, d}, {w, 0, d}, {w, 0, 0}}}, coarse);
  add_quad(mesh, {{{0, h, 0}, {w, h, 0}, {w, h, d}, {0, h, d}}}, coarse);
  add_quad(mesh, {{{0, 0, 0}, {0, h, 0}, {0, h, d}, {0, 0, d}}}, coarse);
  add_quad(mesh, {{{w, 0, 0}, {w, 0, d}, {w, h, d}, {w, h, 0}}}, coarse);
  add_quad(mesh, {{{0, 0, d}, {w, 0, d}, {w, h, d}, {0, h, d}}}, coarse);
  const bool windows = draw.chance(0.6);
  if (windows)
    add_wall(mesh,
             {.corner = {w, 0, 0}, .along = {-1, 0, 0}, .out = {0, 0, -1}, .length = w, .height = h, .thickness = 0.2},
             draw.whole(1, 3), {.width = draw.between(0.6, 0.9), .sill = 0.9, .springing = 1.8, .rise = 0.2}, coarse);
  else
    add_quad(mesh, {{{0, 0, 0}, {w, 0, 0}, {w, h, 0}, {0, h, 0}}}, coarse);
  paint(mesh, 0);
  const int pieces = draw.whole(2, 14);
  for (int i = 0; i < pieces; ++i) {
    const glm::dvec3 corner{draw.between(0.1, w - 2), 0.001, draw.between(0.1, d - 2)};
    const int kind = draw.whole(0, 2);
    if (kind == 0) add_block(mesh, corner, draw.in({0.3, 0.2, 0.3}, {1.5, 1.6, 1}), draw.between(0, 0.5), fine);
    if (kind == 1) add_stand(mesh, draw, corner, fine);
    if (kind == 2) add_boards(mesh, draw, corner, fine);
    paint(mesh, static_cast<std::uint16_t>(1 + i % 2));
  }
  if (windows) lit_mesh.lights.push_back({AreaLight{{0, 0, -0.3}, {w, 0, 0}, {0, h, 0}}, draw.between(0.3, 2)});
  if (!windows || draw.chance(0.5)) {
    const double lamp = draw.between(0.2, 1);
    lit_mesh.lights.push_back(
        {AreaLight{{draw.between(0, w - lamp), h - 0.05, draw.between(0, d - lamp)}, {lamp, 0, 0}, {0, 0, lamp}}});
  }
  return lit_mesh;
}

}  // namespace detp::sim::families
