#include "draw.hpp"
#include "families.hpp"

namespace detp::sim::families {

built_in::LitMesh details(std::uint64_t seed) {
  Draw draw(seed, 6);
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_materials(mesh, draw, 2);
  const double side = draw.log_between(2, 100);
  const double half = side / 2;
  add_quad(mesh, {{{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}}},
           side / draw.log_between(10, 60));
  paint(mesh, 0);
  const int count = draw.whole(1, 20);
  const double size = draw.log_between(0.003, 0.06) * side;
  const int cells = static_cast<int>(draw.log_between(6, 30));
  for (int i = 0; i < count; ++i) {
    const double radius = size * draw.log_between(0.3, 1);
    const glm::dvec3 place = draw.in({-0.9, 0, -0.9}, {0.9, 0, 0.9}) * half;
    if (draw.chance(0.5)) {
      add_ball(mesh, place + glm::dvec3{0, radius, 0}, radius, cells);
    } else {
      const glm::dvec3 edge = radius * draw.in({0.2, 0.2, 0.2}, {1, 1, 1});
      add_box(mesh, place, {{{edge.x, 0, 0}, {0, edge.y, 0}, {0, 0, edge.z}}}, radius / cells);
    }
    paint(mesh, 1);
  }
  lit_mesh.lights = daylight(draw, side, draw.between(0.2, 1) * side);
  return lit_mesh;
}

}  // namespace detp::sim::families
