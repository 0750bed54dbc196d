#include "built_in.hpp"
#include "mesh_pieces.hpp"
#include "wall.hpp"

namespace detp::sim::built_in {
namespace {

constexpr double width = 6;  // along X
constexpr double depth = 5;  // along Z
constexpr double height = 2.8;
constexpr double thickness = 0.2;  // of the wall with windows
constexpr double coarse = 0.12;    // cells of floor, walls and ceiling
constexpr double fine = 0.05;      // cells of furniture

enum InteriorPaint : std::uint16_t { plaster, parquet, wood, fabric, mirror, water_glass };

/// A box that stands upright, with edges along the axes.
struct Upright {
  glm::dvec3 corner;
  glm::dvec3 size;
};

void add(Mesh& mesh, const Upright& box) {
  add_box(mesh, box.corner, {{{box.size.x, 0, 0}, {0, box.size.y, 0}, {0, 0, box.size.z}}}, fine);
}

void add_walls(Mesh& mesh) {
  add_quad(mesh, {{{0, 0, 0}, {0, 0, depth}, {width, 0, depth}, {width, 0, 0}}}, coarse);
  paint(mesh, parquet);
  add_quad(mesh, {{{0, height, 0}, {width, height, 0}, {width, height, depth}, {0, height, depth}}}, coarse);
  add_quad(mesh, {{{0, 0, 0}, {0, height, 0}, {0, height, depth}, {0, 0, depth}}}, coarse);
  add_quad(mesh, {{{width, 0, 0}, {width, 0, depth}, {width, height, depth}, {width, height, 0}}}, coarse);
  add_quad(mesh, {{{0, 0, depth}, {0, height, depth}, {width, height, depth}, {width, 0, depth}}}, coarse);
  const Wall windows{.corner = {width, 0, 0},
                     .along = {-1, 0, 0},
                     .out = {0, 0, -1},
                     .length = width,
                     .height = height,
                     .thickness = thickness};
  add_wall(mesh, windows, 2, {.width = 1.6, .sill = 0.9, .springing = 1.9, .rise = 0.3}, coarse);
  paint(mesh, plaster);
}

/// A top on four legs.
void add_table(Mesh& mesh, const Upright& around) {
  constexpr double leg = 0.07;
  constexpr double top = 0.04;
  const auto& [corner, size] = around;
  for (const double x : {0.0, size.x - leg})
    for (const double z : {0.0, size.z - leg}) add(mesh, {corner + glm::dvec3{x, 0, z}, {leg, size.y - top, leg}});
  add(mesh, {corner + glm::dvec3{0, size.y - top, 0}, {size.x, top, size.z}});
}

void add_chair(Mesh& mesh, const glm::dvec3& corner, bool back_at_far_end) {
  add_table(mesh, {corner, {0.45, 0.46, 0.45}});
  add(mesh, {corner + glm::dvec3{0, 0.46, back_at_far_end ? 0.41 : 0.0}, {0.45, 0.5, 0.04}});
}

/// Two sides and five boards; open in front and at the back.
void add_shelf(Mesh& mesh, const Upright& around) {
  constexpr double board = 0.03;
  const auto& [corner, size] = around;
  for (const double z : {0.0, size.z - board}) add(mesh, {corner + glm::dvec3{0, 0, z}, {size.x, size.y, board}});
  for (int i = 0; i < 5; ++i)
    add(mesh, {corner + glm::dvec3{0, 0.25 * i * (size.y - board), board}, {size.x, board, size.z - 2 * board}});
}

void add_sofa(Mesh& mesh, const glm::dvec3& corner) {
  add(mesh, {corner, {2.1, 0.42, 0.9}});
  add(mesh, {corner + glm::dvec3{0, 0.42, 0.68}, {2.1, 0.45, 0.22}});
  for (const double x : {0.0, 1.9}) add(mesh, {corner + glm::dvec3{x, 0.42, 0}, {0.2, 0.2, 0.68}});
}

}  // namespace

LitMesh interior() {
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  mesh.materials.all = {{.name = "plaster", .diffuse = 0.75},
                        {.name = "parquet", .diffuse = 0.35, .specular = 0.1, .shininess = 60},
                        {.name = "wood", .diffuse = 0.4},
                        {.name = "fabric", .diffuse = 0.3},
                        {.name = "mirror", .diffuse = 0, .specular = 0.92},
                        {.name = "glass", .diffuse = 0, .glass = 1, .index = 1.5}};
  add_walls(mesh);
  add_table(mesh, {{2.2, 0, 1.2}, {1.8, 0.74, 0.9}});
  for (const double x : {2.4, 3.3}) add_chair(mesh, {x, 0, 0.7}, false);
  for (const double x : {2.4, 3.3}) add_chair(mesh, {x, 0, 2.15}, true);
  add_shelf(mesh, {{0.01, 0, 2.2}, {0.3, 2, 1.8}});
  paint(mesh, wood);
  add_sofa(mesh, {3.2, 0, 4});
  paint(mesh, fabric);
  add_quad(mesh, {{{5.99, 0.8, 1.5}, {5.99, 0.8, 2.7}, {5.99, 2.1, 2.7}, {5.99, 2.1, 1.5}}}, coarse);
  paint(mesh, mirror);
  const std::array path{glm::dvec3{2.9, 0.741, 1.6}, glm::dvec3{2.9, 0.95, 1.6}};
  add_tube(mesh, {.path = path, .radii = std::array{0.04, 0.05}, .sides = 24});
  paint(mesh, water_glass);
  lit_mesh.lights = {{AreaLight{{2.6, 2.75, 1.4}, {1, 0, 0}, {0, 0, 0.5}}, 0.35},
                     {PointLight{{0.6, 1.5, 4.4}}, 0.15},
                     {SpotLight{{1.2, 2.7, 3.1}, {-0.4, -1, 0}, 0.5}, 0.1},
                     {AreaLight{{0, 0, -0.25}, {width, 0, 0}, {0, height, 0}}, 0.25},
                     {DirectionalLight{{0.35, -0.6, 0.72}}, 0.15}};
  return lit_mesh;
}

}  // namespace detp::sim::built_in
