#include "detp/sim/lists/simd/binary_tree.hpp"

#include <doctest/doctest.h>

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("the builder of box trees splits a node by the constants that the closed forms use") {
    const float area = 2;
    const float children = 3;
    const float below = 5;
    const double as_inner = box_tree_split::cull * area + box_tree_split::list * children + below;
    for (int discs = 1; discs <= 2 * box_tree_split::largest_leaf; ++discs) {
      CAPTURE(discs);
      const sim::stream::NodeCost node(area, static_cast<std::uint32_t>(discs), children, below);
      CHECK(node.inner == (static_cast<double>(discs) * area > as_inner));
      CHECK(node.cost == doctest::Approx(node.inner ? as_inner : static_cast<double>(discs) * area).epsilon(1e-6));
      const sim::stream::NodeCost costly(area, static_cast<std::uint32_t>(discs), children, 1000);
      CHECK(costly.inner == (discs > box_tree_split::largest_leaf));
    }
  }
}
