#include "detp/sim/scene/built_in/plant.hpp"

#include "detp/sim/scene/built_in/ground.hpp"
#include "draw.hpp"
#include "families.hpp"

namespace detp::sim::families {
namespace {

Generation generation(Draw& draw, int limbs) {
  return {.limbs = limbs,
          .from = draw.between(0.1, 0.5),
          .to = 1,
          .length = draw.between(0.3, 1),
          .shortening = draw.between(0, 0.8),
          .thickness = draw.between(0.35, 0.65),
          .angle = draw.between(0.5, 1.5),
          .lift = draw.between(-0.2, 0.5),
          .wobble = draw.between(0.03, 0.2)};
}

}  // namespace

built_in::LitMesh plant(std::uint64_t seed) {
  Draw draw(seed, 2);
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_materials(mesh, draw, 2);
  const double side = draw.between(8, 30);
  const Ground ground{.side = side,
                      .cells = draw.whole(10, 80),
                      .relief = draw.between(0, 0.1) * side,
                      .hill_size = draw.between(0.1, 0.5) * side,
                      .seed = draw.seed()};
  add_ground(mesh, ground);
  paint(mesh, 0);
  const int plants = draw.whole(1, 4);
  double top = 0;
  for (int i = 0; i < plants; ++i) {
    const glm::dvec3 place = draw.in({-0.3, 0, -0.3}, {0.3, 0, 0.3}) * side;
    const double height = draw.between(0.1, 0.4) * side;
    const Plant plant{.foot = {place.x, ground.height(place.x, place.z) - 0.02 * height, place.z},
                      .height = height,
                      .radius = draw.between(0.02, 0.08) * height,
                      .generations = {generation(draw, draw.whole(4, 12)), generation(draw, draw.whole(3, 7))},
                      .edge = draw.between(0.03, 0.06) * height,
                      .seed = draw.seed()};
    const auto limbs = grow(plant);
    for (const auto& limb : limbs) add_limbs(mesh, limb);
    add_foliage(mesh, limbs.back(),
                {.leaves = static_cast<std::size_t>(draw.log_between(100, 6000)),
                 .length = draw.between(0.02, 0.08) * height,
                 .width = draw.between(0.01, 0.04) * height,
                 .droop = draw.between(0, 0.5),
                 .seed = draw.seed()});
    paint(mesh, 1);
    top = std::max(top, 2.5 * height);
  }
  lit_mesh.lights = daylight(draw, side, top);
  return lit_mesh;
}

}  // namespace detp::sim::families
