#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "detp/sim/scene/built_in/built_in.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "detp/sim/scene/built_in/random_sequence.hpp"

/// What the families draw at random.
namespace detp::sim::families {

using namespace built_in;

class Draw {
 public:
  /// `family` keeps scenes of different families with the same seed apart.
  Draw(std::uint64_t seed, std::uint64_t family) : sequence_(seed * 64 + family) {}

  [[nodiscard]] double between(double low, double high) { return sequence_.between(low, high); }
  [[nodiscard]] double log_between(double low, double high) { return low * std::pow(high / low, between(0, 1)); }
  [[nodiscard]] int whole(int low, int high) { return static_cast<int>(std::floor(between(low, high + 1.0))); }
  [[nodiscard]] bool chance(double probability) { return between(0, 1) < probability; }
  [[nodiscard]] glm::dvec3 in(const glm::dvec3& low, const glm::dvec3& high) {
    const double x = between(low.x, high.x);
    const double y = between(low.y, high.y);
    return {x, y, between(low.z, high.z)};
  }
  /// A seed for parts of a scene.
  [[nodiscard]] std::uint64_t seed() { return static_cast<std::uint64_t>(between(1, 1e15)); }
  /// Diffuse, sometimes with some gloss.
  [[nodiscard]] Material material(const std::string& name) {
    Material one{.name = name, .diffuse = between(0.15, 0.8)};
    if (!chance(0.3)) return one;
    one.specular = between(0.05, 0.95 - one.diffuse);
    one.shininess = log_between(10, 1000);
    return one;
  }

 private:
  RandomSequence sequence_;
};

/// Adds `count` materials.
inline void add_materials(Mesh& mesh, Draw& draw, int count) {
  for (int i = 0; i < count; ++i) mesh.materials.all.push_back(draw.material("material " + std::to_string(i + 1)));
}

/// The sky over a square of this side at this height, or the sun, or both.
[[nodiscard]] inline std::vector<Light> daylight(Draw& draw, double side, double height) {
  std::vector<Light> lights;
  const bool sky = draw.chance(0.7);
  if (sky)
    lights.push_back(
        {AreaLight{.corner = {-side / 2, height, -side / 2}, .edge_u = {side, 0, 0}, .edge_v = {0, 0, side}}});
  if (!sky || draw.chance(0.4)) {
    const double lean = draw.between(0, 1);
    const double turn = draw.between(0, 6.283);
    lights.push_back({DirectionalLight{{lean * std::cos(turn), -1, lean * std::sin(turn)}}, draw.between(0.3, 2)});
  }
  return lights;
}

}  // namespace detp::sim::families
