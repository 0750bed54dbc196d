#pragma once

#include <array>

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

  [[nodiscard]] RayInterval inside(const Box& box) const {
    return clipped_.inside({box.low - slack_, box.high + slack_});
  }

  template <class Search>
  void visit_all(std::uint32_t number, const Box& box, int level, std::uint32_t ray, Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const OctreeNode& node = tree_.nodes[number];
    if (level == tree_.depth) return search.test(ray, tree_.references_in(node));
    for_each_child(node, box, [&](std::uint32_t child, const Box& part) {
      if (!inside(part).empty()) visit_all(child, part, level + 1, ray, search);
    });
  }

  template <class Search>
  void visit_in_order(std::uint32_t number, const Box& box, int level, std::uint32_t ray, Search& search) const {
    search.visit(&Counts<std::uint64_t>::nodes);
    const OctreeNode& node = tree_.nodes[number];
    if (level == tree_.depth) return search.test(ray, tree_.references_in(node));
    std::array<CrossedChild, 8> crossed;
    std::size_t count = 0;
    for_each_child(node, box, [&](std::uint32_t child, const Box& part) {
      const RayInterval interval = inside(part);
      if (interval.empty()) return;
      std::size_t place = count++;
      for (; place > 0 && crossed[place - 1].from > interval.from; --place) crossed[place] = crossed[place - 1];
      crossed[place] = {interval.from, child, part};
    });
    for (std::size_t i = 0; i < count; ++i) visit_in_order(crossed[i].number, crossed[i].box, level + 1, ray, search);
  }

  const OctreeNodes& tree_;
  const ClippedRay& clipped_;
  double slack_;
};

}  // namespace detp::sim
