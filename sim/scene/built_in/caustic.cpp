#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "built_in.hpp"
#include "mesh_pieces.hpp"

namespace detp::sim::built_in {
namespace {

using std::numbers::pi;

constexpr double floor_side = 4;
constexpr double floor_cell = 0.05;
constexpr glm::dvec3 ball{1.3, 0.9, 1.6};
constexpr double ball_radius = 0.45;
constexpr glm::dvec3 ring{2.8, 0, 2.4};
constexpr double ring_radius = 0.6;
constexpr double ring_height = 0.25;

enum CausticPaint : std::uint16_t { floor_plaster, ball_glass, ring_brass };

/// A strip that stands on the floor around two thirds of a circle. Its inside is polished.
void add_ring(Mesh& mesh) {
  add_patch(mesh, {80, 6}, [](double u, double v) {
    const double phi = 4 * pi / 3 * u;
    return ring + glm::dvec3{ring_radius * std::cos(phi), ring_height * v, ring_radius * std::sin(phi)};
  });
}

}  // namespace

LitMesh caustic() {
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  mesh.materials.all = {{.name = "plaster", .diffuse = 0.6},
                        {.name = "glass", .diffuse = 0, .glass = 1, .index = 1.5},
                        {.name = "brass", .diffuse = 0.1, .specular = 0.8, .shininess = 3000}};
  add_quad(mesh, {{{0, 0, 0}, {0, 0, floor_side}, {floor_side, 0, floor_side}, {floor_side, 0, 0}}}, floor_cell);
  add_quad(mesh, {{{0, 0, 0}, {floor_side, 0, 0}, {floor_side, 2.5, 0}, {0, 2.5, 0}}}, 2 * floor_cell);
  paint(mesh, floor_plaster);
  add_ball(mesh, ball, ball_radius, 32);
  paint(mesh, ball_glass);
  add_ring(mesh);
  paint(mesh, ring_brass);
  const glm::dvec3 spot{0.6, 3.2, 1.2};
  lit_mesh.lights = {{SpotLight{spot, ball - spot, std::atan(1.1 * ball_radius / glm::distance(spot, ball))}, 0.05},
                     {PointLight{{3.9, 1.1, 3.4}}, 0.25},
                     {AreaLight{{1, 3, 1}, {2, 0, 0}, {0, 0, 2}}, 0.7}};
  return lit_mesh;
}

}  // namespace detp::sim::built_in
