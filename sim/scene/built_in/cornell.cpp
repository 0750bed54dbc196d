#include <cmath>

#include "built_in.hpp"
#include "mesh_pieces.hpp"

namespace detp::sim::built_in {
namespace {

constexpr double cell = 1.0 / 28;

enum Paint : std::uint16_t { white, red, green };

struct Block {
  double x, z;    ///< centre of its base
  double height;  ///< its base is a square of side 0.3
  double turn;    ///< rotation about the vertical, radians
};

/// Four sides and a top. The block stands on the floor and has no bottom.
void add_block(Mesh& mesh, const Block& block) {
  constexpr double side = 0.3;
  const glm::dvec3 u = side * glm::dvec3{std::cos(block.turn), 0, -std::sin(block.turn)};
  const glm::dvec3 v = side * glm::dvec3{std::sin(block.turn), 0, std::cos(block.turn)};
  const glm::dvec3 up{0, block.height, 0};
  const glm::dvec3 corner = glm::dvec3{block.x, 0, block.z} - 0.5 * (u + v);
  const std::array base{corner, corner + v, corner + u + v, corner + u};
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3& a = base[i];
    const glm::dvec3& b = base[(i + 1) % 4];
    add_quad(mesh, {a, b, b + up, a + up}, cell);
  }
  add_quad(mesh, {base[0] + up, base[1] + up, base[2] + up, base[3] + up}, cell);
}

void add_room(Mesh& mesh) {
  add_quad(mesh, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}, cell);  // floor
  add_quad(mesh, {{{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}}, cell);  // ceiling
  add_quad(mesh, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, cell);  // back
  paint(mesh, white);
  add_quad(mesh, {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}, cell);  // left
  paint(mesh, red);
  add_quad(mesh, {{{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}}, cell);  // right
  paint(mesh, green);
}

}  // namespace

LitMesh cornell() {
  LitMesh lit_mesh;
  lit_mesh.mesh.materials.all = {{.name = "white"},
                                 {.name = "red", .colours = Colours{.diffuse = {0.6, 0.1, 0.05}}},
                                 {.name = "green", .colours = Colours{.diffuse = {0.1, 0.5, 0.1}}}};
  add_room(lit_mesh.mesh);
  add_block(lit_mesh.mesh, {.x = 0.34, .z = 0.36, .height = 0.6, .turn = 0.3});
  add_block(lit_mesh.mesh, {.x = 0.66, .z = 0.68, .height = 0.3, .turn = -0.3});
  paint(lit_mesh.mesh, white);
  lit_mesh.lights = {{AreaLight{.corner = {0.38, 0.999, 0.4}, .edge_u = {0.24, 0, 0}, .edge_v = {0, 0, 0.2}}}};
  return lit_mesh;
}

}  // namespace detp::sim::built_in
