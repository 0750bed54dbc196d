#include <numbers>

#include "built_in.hpp"
#include "mesh_pieces.hpp"

namespace detp::sim::built_in {

LitMesh furnace() {
  constexpr double cell = 1.0 / 16;
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_quad(mesh, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}, cell);
  add_quad(mesh, {{{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}}, cell);
  add_quad(mesh, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, cell);
  add_quad(mesh, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}, cell);
  add_quad(mesh, {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}, cell);
  add_quad(mesh, {{{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}}, cell);
  mesh.materials.all = {{.name = "wall", .diffuse = 0.5, .emitted = 1}};
  paint(mesh, 0);
  lit_mesh.lights = {{SurfaceLight{}, 6 * std::numbers::pi}};
  lit_mesh.known_irradiance = 2 * std::numbers::pi;
  return lit_mesh;
}

}  // namespace detp::sim::built_in
