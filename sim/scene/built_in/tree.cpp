#include "built_in.hpp"
#include "ground.hpp"
#include "plant.hpp"

namespace detp::sim::built_in {
namespace {

/// An area light above the whole ground that shines down.
AreaLight light_over(const Ground& ground, double height) {
  const double half = 0.5 * ground.side;
  return {.corner = {-half, height, -half}, .edge_u = {ground.side, 0, 0}, .edge_v = {0, 0, ground.side}};
}

/// The ground, the limbs, and enough leaves to bring the mesh to the requested number of triangles.
Mesh landscape(const Ground& ground, const Plant& plant, Foliage foliage, std::size_t triangles) {
  Mesh mesh;
  add_ground(mesh, ground);
  const auto limbs = grow(plant);
  for (const auto& generation : limbs) add_limbs(mesh, generation);
  foliage.leaves = (triangles - mesh.triangles.size()) / triangles_of_a_leaf;
  add_foliage(mesh, limbs.back(), foliage);
  return mesh;
}

}  // namespace

LitMesh tree() {
  const Ground ground{.side = 12, .cells = 57, .relief = 1, .hill_size = 3, .seed = 11};
  const Plant plant{.foot = {0, ground.height(0, 0) - 0.1, 0},
                    .height = 4,
                    .radius = 0.32,
                    .generations = {{.limbs = 9,
                                     .from = 0.55,
                                     .to = 1,
                                     .length = 1.05,
                                     .shortening = 0.3,
                                     .thickness = 0.55,
                                     .angle = 0.95,
                                     .lift = 0.5,
                                     .wobble = 0.1},
                                    {.limbs = 8,
                                     .from = 0.3,
                                     .to = 1,
                                     .length = 0.45,
                                     .shortening = 0.3,
                                     .thickness = 0.55,
                                     .angle = 0.8,
                                     .lift = 0.2,
                                     .wobble = 0.12},
                                    {.limbs = 8,
                                     .from = 0.25,
                                     .to = 1,
                                     .length = 0.45,
                                     .shortening = 0.3,
                                     .thickness = 0.55,
                                     .angle = 0.8,
                                     .lift = 0.1,
                                     .wobble = 0.15}},
                    .edge = 0.124,
                    .seed = 12};
  const Foliage foliage{.leaves = 0, .length = 0.23, .width = 0.115, .droop = 0.25, .seed = 13};
  return {.mesh = landscape(ground, plant, foliage, 72'500), .lights = {{light_over(ground, 9)}}};
}

LitMesh tree_coarse() {
  const Ground ground{.side = 24, .cells = 28, .relief = 4, .hill_size = 7, .seed = 21};
  const Plant plant{.foot = {0, ground.height(0, 0) - 0.3, 0},
                    .height = 18,
                    .radius = 0.4,
                    .generations = {{.limbs = 56,
                                     .from = 0.12,
                                     .to = 0.98,
                                     .length = 0.36,
                                     .shortening = 0.92,
                                     .thickness = 0.35,
                                     .angle = 1.65,
                                     .lift = 0.15,
                                     .wobble = 0.06},
                                    {.limbs = 6,
                                     .from = 0.25,
                                     .to = 0.95,
                                     .length = 0.4,
                                     .shortening = 0.6,
                                     .thickness = 0.6,
                                     .angle = 0.9,
                                     .lift = -0.1,
                                     .wobble = 0.1}},
                    .edge = 0.48,
                    .seed = 24};
  const Foliage foliage{.leaves = 0, .length = 1.1, .width = 0.45, .droop = 0.3, .seed = 23};
  return {.mesh = landscape(ground, plant, foliage, 18'000), .lights = {{light_over(ground, 21)}}};
}

}  // namespace detp::sim::built_in
