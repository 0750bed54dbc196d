#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "detp/sim/geometry/ray_box.hpp"
#include "octree_nodes.hpp"

namespace detp::sim {

/// Calls visit(child, its box) for each of an inner node's children, in the order of their octants.
template <class VisitChild>
void for_each_child(const OctreeNode& node, const Box& box, const VisitChild& visit) {
  std::uint32_t child = node.first;
  for (unsigned octant = 0; octant < 8; ++octant)
    if (node.octants >> octant & 1) visit(child++, octant_of(box, octant));
}

/// Takes one ray, which must cross the cube, from the root of an octree into every node that the ray crosses.
class OctreeDescent {
 public:
  OctreeDescent(const OctreeNodes& tree, const ClippedRay& clipped, double slack)
      : tree_(tree), clipped_(clipped), slack_(slack) {}

  /// Visits children in the order of their octants.
  template <class Search>
  void visit_all(std::uint32_t ray, Search& search) const {
    visit_all(0, tree_.cube, 0, ray, search);
  }

  /// Visits the same nodes as visit_all, but the children of each node in the order in which the ray enters them.
  /// Children that it enters at the same distance are visited in the order of their octants.
  template <class Search>
  void visit_in_order(std::uint32_t ray, Search& search) const {
    visit_in_order(0, tree_.cube, 0, ray, search);
  }

 private:
  struct CrossedChild {
    double from;
    std::uint32_t number;
    Box box;
  };

  /// The ray's intervals between pairs of planes: in the lower and the upper half of a box along each axis, grown by the slack. A
  /// child's interval is that in three of them, so its planes need not be crossed again for each child.
  class Halves {
   public:
    Halves(const ClippedRay& ray, const Box& box, double slack) : whole_(ray.whole) {
      const glm::dvec3 middle = box.centre();
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        halves_[at] = {between(ray, axis, box.low[axis] - slack, middle[axis] + slack),
                       between(ray, axis, middle[axis] - slack, box.high[axis] + slack)};
      }
    }

    /// What ClippedRay::inside returns for the child's grown box.
    [[nodiscard]] RayInterval in_octant(unsigned octant) const {
      const RayInterval& x = halves_[0][octant & 1];
      const RayInterval& y = halves_[1][octant >> 1 & 1];
      const RayInterval& z = halves_[2][octant >> 2 & 1];
      return {std::max(std::max(whole_.from, x.from), std::max(y.from, z.from)),
              std::min(std::min(whole_.to, x.to), std::min(y.to, z.to))};
    }

   private:
    static RayInterval between(const ClippedRay& ray, int axis, double low, double high) {
      if (std::isinf(ray.inverse[axis])) {
        if (ray.origin[axis] < low || ray.origin[axis] > high) return {unbounded, -unbounded};
        return {-unbounded, unbounded};
      }
      const double a = (low - ray.origin[axis]) * ray.inverse[axis];
      const double b = (high - ray.origin[axis]) * ray.inverse[axis];
      return {std::min(a, b), std::max(a, b)};
    }

    RayInterval whole_;
    std::array<std::array<RayInterval, 2>, 3> halves_;
  };

  /// Calls visit(child, octant, interval) for the children that the ray crosses, in the order of their octants.
  template <class VisitChild>
  void for_each_crossed(const OctreeNode& node, const Box& box, const VisitChild& visit) const {
    const Halves halves(clipped_, box, slack_);
    std::uint32_t child = node.first;
    for (unsigned left = node.octants; left != 0; left &= left - 1, ++child) {
      const auto octant = static_cast<unsigned>(std::countr_zero(left));
      if (const RayInterval interval = halves.in_octant(octant); !interval.empty()) visit(child, octant, interval);
    }
  }

  template <class Search>
  void visit_all(std::uint32_t number, const Box& box, int level, std::uint32_t ray, Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const OctreeNode& node = tree_.nodes[number];
    if (level == tree_.depth) return search.test(ray, tree_.references_in(node));
    for_each_crossed(node, box, [&](std::uint32_t child, unsigned octant, const RayInterval&) {
      visit_all(child, octant_of(box, octant), level + 1, ray, search);
    });
  }

  template <class Search>
  void visit_in_order(std::uint32_t number, const Box& box, int level, std::uint32_t ray, Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const OctreeNode& node = tree_.nodes[number];
    if (level == tree_.depth) return search.test(ray, tree_.references_in(node));
    std::array<CrossedChild, 8> crossed;
    std::size_t count = 0;
    for_each_crossed(node, box, [&](std::uint32_t child, unsigned octant, const RayInterval& interval) {
      std::size_t place = count++;
      for (; place > 0 && crossed[place - 1].from > interval.from; --place) crossed[place] = crossed[place - 1];
      crossed[place] = {interval.from, child, octant_of(box, octant)};
    });
    for (std::size_t i = 0; i < count; ++i) visit_in_order(crossed[i].number, crossed[i].box, level + 1, ray, search);
  }

  const OctreeNodes& tree_;
  const ClippedRay& clipped_;
  double slack_;
};

}  // namespace detp::sim
