#include "detp/sim/index/octree_nodes.hpp"

#include <doctest/doctest.h>

#include "detp/sim/open/uniform_discs.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

std::vector<Box> boxes_of(const std::vector<LinkedNode>& nodes, const Box& cube) {
  std::vector<Box> boxes(nodes.size());
  boxes[0] = cube;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].inner)
      for (unsigned octant = 0; octant < 8; ++octant) boxes[nodes[i].first + octant] = octant_of(boxes[i], octant);
  return boxes;
}

/// Whether box b adjoins that face of box a from outside, and covers the whole face.
bool covers(const Box& b, const Box& a, int face) {
  const int axis = face / 2;
  if (face % 2 == 0 ? b.high[axis] != a.low[axis] : b.low[axis] != a.high[axis]) return false;
  for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
    if (b.low[other] > a.low[other] || b.high[other] < a.high[other]) return false;
  return true;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("every link leads to the node of the same size behind the face, or to the larger leaf there") {
    const auto discs = uniform_discs(Body::cube_faces, 2, 300, 0.02, 9);
    const std::vector<Ray> rays{{}};
    const OctreeNodes tree = build_octree(make_problem(rays, discs), 5, Insertion::exact, {});
    const std::vector<LinkedNode> nodes = link_neighbours(tree, {});
    const std::vector<Box> boxes = boxes_of(nodes, tree.cube);
    std::size_t larger = 0;
    std::size_t references = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!nodes[i].inner) references += nodes[i].count;
      for (int face = 0; face < 6; ++face) {
        const std::uint32_t link = nodes[i].links[static_cast<std::size_t>(face)];
        const int axis = face / 2;
        const bool outer =
            face % 2 == 0 ? boxes[i].low[axis] == tree.cube.low[axis] : boxes[i].high[axis] == tree.cube.high[axis];
        REQUIRE((link == no_node) == outer);
        if (outer) continue;
        REQUIRE(covers(boxes[link], boxes[i], face));
        REQUIRE(nodes[link].level <= nodes[i].level);
        if (nodes[link].level == nodes[i].level) continue;
        REQUIRE_FALSE(nodes[link].inner);
        ++larger;
      }
    }
    CHECK(larger > 100);
    CHECK(references == tree.references.size());
  }

  TEST_CASE("a root without children is a leaf without links") {
    const std::vector<Disc> discs{{}};
    const std::vector<Ray> rays{{}};
    const std::vector<LinkedNode> nodes =
        link_neighbours(build_octree(make_problem(rays, discs), 0, Insertion::exact, {}), {});
    REQUIRE(nodes.size() == 1);
    CHECK_FALSE(nodes[0].inner);
    CHECK(nodes[0].count == 1);
    for (const std::uint32_t link : nodes[0].links) CHECK(link == no_node);
  }
}
