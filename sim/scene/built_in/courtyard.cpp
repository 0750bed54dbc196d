
#include "built_in.hpp"
#include "mesh_pieces.hpp"
#include "wall.hpp"

namespace detp::sim::built_in {
namespace {

constexpr double court = 10;     // half the width of the open court
constexpr double rooms = 13;     // from the middle to the wall between gallery and rooms
constexpr double outside = 20;   // from the middle to the outer face
constexpr double storey = 4.2;   // from floor to floor
constexpr double ceiling = 3.9;  // height above the storey's floor
constexpr double ridge = 10.9;   // height above the court
constexpr double arcade = 0.4;   // thickness of the piers
constexpr double partition = 0.3;
constexpr double outer_wall = 0.4;
constexpr double cell_side = 0.515;

constexpr glm::dvec3 up{0, 1, 0};

/// One of the four sides of the building, seen from the middle of the court.
struct Side {
  glm::dvec3 along;
  glm::dvec3 out;

  [[nodiscard]] glm::dvec3 point(double x, double y, double z) const { return x * along + y * up + z * out; }
};

constexpr std::array<Side, 4> sides{
    {{{1, 0, 0}, {0, 0, 1}}, {{0, 0, -1}, {1, 0, 0}}, {{-1, 0, 0}, {0, 0, -1}}, {{0, 0, 1}, {-1, 0, 0}}}};

/// A square around the court.
struct Square {
  double half;
  double y;
};

/// The area between two squares, like a picture frame. It faces up if `second` is the outer square.
void add_frame(Mesh& mesh, const Square& first, const Square& second) {
  for (const Side& side : sides)
    add_quad(mesh,
             {side.point(-first.half, first.y, first.half), side.point(-second.half, second.y, second.half),
              side.point(second.half, second.y, second.half), side.point(first.half, first.y, first.half)},
             cell_side);
}

void add_partitions(Mesh& mesh, const Side& side, double floor) {
  const Opening door{.width = 1.2, .sill = 0, .springing = 2.1, .rise = 0.3};
  for (const double x : {-rooms, -rooms / 3, rooms / 3, rooms}) {
    const Wall wall{.corner = side.point(x + 0.5 * partition, floor, rooms + partition),
                    .along = side.out,
                    .out = -side.along,
                    .length = outside - outer_wall - rooms - partition,
                    .height = ceiling,
                    .thickness = partition};
    add_wall(mesh, wall, 1, door, cell_side);
  }
}

/// One storey on one side: arcade, wall of the rooms, partitions and outer wall.
void add_storey(Mesh& mesh, const Side& side, int level) {
  const double floor = level * storey;
  const auto wall = [&](double half, double z, double height, double thickness) {
    return Wall{side.point(-half, floor, z), side.along, side.out, 2 * half, height, thickness};
  };
  const double parapet = level == 0 ? 0.0 : 0.9;
  add_wall(mesh, wall(court, court, storey, arcade), 5, {.width = 3.1, .sill = parapet, .springing = 2.4, .rise = 1},
           cell_side);
  add_wall(mesh, wall(rooms, rooms, ceiling, partition), 6, {.width = 1.4, .sill = 0, .springing = 2.2, .rise = 0.4},
           cell_side);
  add_wall(mesh, wall(outside, outside - outer_wall, storey, outer_wall), 10,
           {.width = 1.4, .sill = 1, .springing = 2.4, .rise = 0.4}, cell_side);
  add_partitions(mesh, side, floor);
  add_box(mesh, side.point(court, floor, court), {arcade * side.along, storey * up, arcade * side.out}, cell_side);
}

void add_storey_slabs(Mesh& mesh, int level) {
  const double floor = level * storey;
  add_frame(mesh, {court, floor}, {outside, floor});
  add_frame(mesh, {outside, floor + ceiling}, {court, floor + ceiling});
}

void add_roof(Mesh& mesh) {
  const double eaves = 2 * storey;
  const double middle = 0.5 * (court + outside);
  add_frame(mesh, {court, eaves}, {middle, ridge});
  add_frame(mesh, {middle, ridge}, {outside, eaves});
}

}  // namespace

LitMesh courtyard() {
  LitMesh lit_mesh;
  Mesh& mesh = lit_mesh.mesh;
  add_quad(mesh, {{{-court, 0, -court}, {-court, 0, court}, {court, 0, court}, {court, 0, -court}}}, cell_side);
  for (int level = 0; level < 2; ++level) {
    add_storey_slabs(mesh, level);
    for (const Side& side : sides) add_storey(mesh, side, level);
  }
  add_roof(mesh);
  lit_mesh.lights = {
      {AreaLight{.corner = {-court, ridge, -court}, .edge_u = {2 * court, 0, 0}, .edge_v = {0, 0, 2 * court}}}};
  return lit_mesh;
}

}  // namespace detp::sim::built_in
