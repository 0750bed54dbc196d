// Makes model/hierarchy/box_tree_sah_leaves.inc: the share of the small nodes (2 to 6 discs) of a box tree that become
// leaves, although the tree's parameter is one disc a leaf: the builder does not split a node if this costs more.
//
//   cmake --build build --target box_tree_sah_leaves_table
//   build/box_tree_sah_leaves_table > model/hierarchy/box_tree_sah_leaves.inc
//
// Draws sets of m discs, uniform in a cell and with isotropic normals, and keeps the sets with discs in both halves of
// the cell. Builds the binary tree of each set by the rule of model/vocabulary/box_tree_split.hpp. The cells are, in order:
//   cells on a face of a cube, in its volume, and at an edge (samples on two faces), each for all shapes of cell (the
//   next cut is across x, y or z);
//   square and cubic cells that the curve does not cut (the discs are split in the middle of an arbitrary order).
// For each cell, each disc radius d = 2⁻⁹, 2^{-8.5} … 2 times the longest side, and each m = 2 … 6, prints
//   the share of the sets that become a leaf,
//   the mean area of the boxes of these leaves divided by that of all sets,
//   the mean cost of the sets divided by the mean area of their boxes.
// Takes some minutes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "detp/model/vocabulary/box_tree_split.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/geometry/random.hpp"

namespace {

using namespace detp;
using sim::Box;
using sim::Disc;

constexpr std::uint64_t seed = 20261122;
constexpr int sets = 40'000;

/// Half the area of the box.
double area_of(const Box& box) {
  const glm::dvec3 side = box.size();
  return side.x * side.y + side.y * side.z + side.z * side.x;
}

struct Cell {
  glm::dvec3 low;
  glm::dvec3 side;
  int axis;  ///< the axis across which the next cut is
  int axes;  ///< number of axes that are cut in turn; 0: the cell is not cut

  [[nodiscard]] Cell half(bool upper) const {
    Cell cell = *this;
    if (axes == 0) return cell;
    cell.side[axis] /= 2;
    if (upper) cell.low[axis] += cell.side[axis];
    cell.axis = (axis + 1) % axes;
    return cell;
  }
};

struct Built {
  Box box;
  double cost;
  bool leaf;
};

/// Moves the discs in the cell's lower half to the front, and returns their number.
std::size_t divide(const Cell& cell, std::span<Disc> discs) {
  if (cell.axes == 0) return discs.size() / 2;
  const double middle = cell.low[cell.axis] + cell.side[cell.axis] / 2;
  const auto end =
      std::partition(discs.begin(), discs.end(), [&](const Disc& disc) { return disc.centre[cell.axis] < middle; });
  return static_cast<std::size_t>(end - discs.begin());
}

Built build(Cell cell, std::span<Disc> discs) {
  if (discs.size() == 1) {
    const Box box = sim::bounds(discs[0], 0);
    return {box, area_of(box), true};
  }
  std::size_t lower = divide(cell, discs);
  while (lower == 0 || lower == discs.size()) {
    cell = cell.half(lower == 0);
    lower = divide(cell, discs);
  }
  const Built left = build(cell.half(false), discs.first(lower));
  const Built right = build(cell.half(true), discs.subspan(lower));
  Box box = left.box;
  box.include(right.box.low);
  box.include(right.box.high);
  const double area = area_of(box);
  const double inner = box_tree_split::cull * area + box_tree_split::list * (area_of(left.box) + area_of(right.box)) +
                       left.cost + right.cost;
  const double as_leaf = static_cast<double>(discs.size()) * area;
  return {box, std::min(as_leaf, inner), as_leaf <= inner};
}

Disc random_disc(const Cell& cell, bool edge, double radius, std::uint64_t number) {
  const auto place = sim::uniform4(seed, sim::Stream::tests, number);
  const auto turn = sim::uniform4(seed, sim::Stream::tests, number, 1);
  Disc disc{cell.side * glm::dvec3(place[0], place[1], place[2]), sim::uniform_direction(turn[0], turn[1]), radius};
  if (edge) {  // on the lower face across x or z, with probabilities proportional to the areas of both faces
    const double of_x = cell.side[1] * cell.side[2];
    const double of_z = cell.side[0] * cell.side[1];
    disc.centre[turn[2] * (of_x + of_z) < of_x ? 0 : 2] = 0;
  }
  return disc;
}

void print_nodes(const Cell& cell, bool edge, double radius, std::size_t discs, std::uint64_t& number) {
  double all = 0;
  double cost = 0;
  double leaves = 0;
  double leaf_area = 0;
  std::vector<Disc> some(discs);
  for (int set = 0; set < sets;) {
    for (Disc& disc : some) disc = random_disc(cell, edge, radius, number++);
    const std::size_t lower = divide(cell, some);
    if (lower == 0 || lower == discs) continue;
    ++set;
    const Built node = build(cell, some);
    const double area = area_of(node.box);
    all += area;
    cost += node.cost;
    if (!node.leaf) continue;
    ++leaves;
    leaf_area += area;
  }
  fmt::print("{:.4f},{:.4f},{:.4f},", leaves / sets, leaves > 0 ? leaf_area / leaves / (all / sets) : 1, cost / all);
}

void print_shape(const Cell& cell, bool edge, std::uint64_t& number) {
  for (int octave = -18; octave <= 2; ++octave) {
    for (const std::size_t discs : {2U, 3U, 4U, 5U, 6U})
      print_nodes(cell, edge, std::exp2(octave / 2.0), discs, number);
    fmt::print("\n");
  }
}

void print_shapes(int axes, bool edge, std::uint64_t& number) {
  Cell cell{{0, 0, 0}, {1, 1, axes == 2 ? 0.0 : 1.0}, 0, axes};
  for (; cell.axis < axes; ++cell.axis) {
    print_shape(cell, edge, number);
    cell.side[cell.axis] = 0.5;
  }
}

}  // namespace

int main() {
  fmt::print("// Made by validate/tools/box_tree_sah_leaves_table.cpp.\n\n");
  fmt::print("constexpr std::array<double, small_shapes * small_radii * small_row> small_table{{{{\n");
  std::uint64_t number = 0;
  print_shapes(2, false, number);
  print_shapes(3, false, number);
  print_shapes(3, true, number);
  print_shape({{0, 0, 0}, {1, 1, 0}, 0, 0}, false, number);
  print_shape({{0, 0, 0}, {1, 1, 1}, 0, 0}, false, number);
  fmt::print("}}}};\n");
}
