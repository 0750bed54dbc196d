#pragma once

#include <array>
#include <cmath>

#include "detp/sim/geometry/ray_box.hpp"

namespace detp::sim {

/// A leaf's number along each axis.
using Leaf = std::array<std::int64_t, 3>;

/// A cube of whole leaves: its lowest leaf and its side, both in leaves.
struct LeafCube {
  Leaf low;
  std::int64_t side;
};

/// The cube in the octree with side `side`, a power of two, that contains the leaf.
[[nodiscard]] inline LeafCube cube_around(const Leaf& leaf, std::int64_t side) {
  LeafCube cube{leaf, side};
  for (std::int64_t& low : cube.low) low -= low % side;
  return cube;
}

/// Number, in its parent, of the octant that contains the leaf and is `levels_below` levels above the leaves.
[[nodiscard]] inline unsigned octant_of(const Leaf& leaf, int levels_below) {
  unsigned octant = 0;
  for (int axis = 0; axis < 3; ++axis) octant |= static_cast<unsigned>(leaf[axis] >> levels_below & 1) << axis;
  return octant;
}

/// Steps through an octree's cube from leaf to leaf, as the grid does from cell to cell, but crosses an omitted octant
/// in one step. The place of each plane is recomputed from its number, so errors do not accumulate.
class LeafWalk {
 public:
  LeafWalk(const Box& cube, int depth)
      : low_(cube.low),
        leaves_(std::int64_t{1} << depth),
        side_(cube.size().x / static_cast<double>(std::int64_t{1} << depth)) {}

  /// Walks along a ray; `interval` is the ray's part in the cube. `enter(leaf, face)` processes the leaf, and returns
  /// the cube that the ray crosses there: the leaf, or the omitted octant around it. `face` is the face through which
  /// the ray left the previous cube: 2 axis + (1 for the upper face); -1 for the first leaf.
  template <class Enter>
  void for_each_leaf(const Ray& ray, const ClippedRay& clipped, const RayInterval& interval, const Enter& enter) const {
    Leaf place = leaf_at(clipped.origin + interval.from * ray.direction, {{}, leaves_});
    for (int face = -1;;) {
      const LeafCube cube = enter(place, face);
      int next = 0;
      double leave = unbounded;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::isinf(clipped.inverse[axis])) continue;
        const auto plane = static_cast<double>(cube.low[axis] + (clipped.inverse[axis] > 0 ? cube.side : 0));
        const double t = (low_[axis] + plane * side_ - clipped.origin[axis]) * clipped.inverse[axis];
        if (t < leave) {
          leave = t;
          next = axis;
        }
      }
      if (!(leave < interval.to)) return;
      const bool up = clipped.inverse[next] > 0;
      place = leaf_at(clipped.origin + leave * ray.direction, cube);
      place[next] = cube.low[next] + (up ? cube.side : -1);
      if (place[next] < 0 || place[next] >= leaves_) return;
      face = 2 * next + (up ? 1 : 0);
    }
  }

 private:
  /// The leaf of the cube `within` that contains the point, or the nearest leaf of it.
  [[nodiscard]] Leaf leaf_at(const glm::dvec3& point, const LeafCube& within) const {
    Leaf leaf{};
    for (int axis = 0; axis < 3; ++axis) {
      const double place = std::floor((point[axis] - low_[axis]) / side_);
      const auto low = static_cast<double>(within.low[axis]);
      leaf[axis] = static_cast<std::int64_t>(std::clamp(place, low, low + static_cast<double>(within.side - 1)));
    }
    return leaf;
  }

  glm::dvec3 low_;
  std::int64_t leaves_;
  double side_;
};

}  // namespace detp::sim
