#include <array>

#include "detp/sim/scene/built_in/ground.hpp"
#include "draw.hpp"
#include "families.hpp"

namespace detp::sim::families {

built_in::LitMesh terrain(std::uint64_t seed) {
  Draw draw(seed, 4);
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_materials(mesh, draw, 1);
  const double side = draw.log_between(10, 5000);
  std::array<Ground, 3> octaves{};
  double relief = draw.log_between(0.02, 0.5) * side;
  double hill_size = draw.between(0.15, 0.6) * side;
  for (Ground& octave : octaves) {
    octave = {.side = side, .cells = 1, .relief = relief, .hill_size = hill_size, .seed = draw.seed()};
    relief *= draw.between(0.2, 0.5);
    hill_size *= draw.between(0.2, 0.5);
  }
  const auto point = [&](double x, double z) {
    glm::dvec3 place{x, 0, z};
    for (const Ground& octave : octaves) place.y += octave.height(x, z);
    return place;
  };
  const int cells = static_cast<int>(draw.log_between(45, 280));
  const double border = draw.between(0.1, 0.9);
  const double share = draw.between(0.1, 0.5);  // of the cells, in the coarser part
  const int coarse = std::max(1, static_cast<int>(share * cells));
  for (const bool first : {true, false}) {
    const double from = first ? 0 : border;
    const double width = first ? border : 1 - border;
    add_patch(mesh, {cells, first ? coarse : cells - coarse},
              [&](double u, double v) { return point((from + v * width - 0.5) * side, (u - 0.5) * side); });
  }
  paint(mesh, 0);
  lit_mesh.lights = daylight(draw, side, side);
  return lit_mesh;
}

}  // namespace detp::sim::families
