#include "detp/model/hierarchy/box_tree_leaf_costs.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>

#include "detp/model/hierarchy/box_tree.hpp"

using namespace detp;
using namespace detp::model;

namespace {

const UnitCosts costs{.cull_test = 0.6, .disc_test = 0.45, .listed = 1.3, .make = 58, .cull = 37, .visit = 15};

double time_with(const Workload& w, int leaf) {
  return price(box_tree_counts(w, BoxTreeParameters{8, leaf}, Engine::simd), costs).total();
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the leaf with the least rough cost is at most 3 % slower than the best one") {
    for (const double dimension : {2.0, 2.5, 3.0})
      for (const double rays : {1e4, 1e6})
        for (const double samples : {1e4, 1e6}) {
          CAPTURE(dimension);
          CAPTURE(rays);
          CAPTURE(samples);
          const Workload w = cube_workload(rays, samples, 0.02, 2, dimension);
          const auto rough = rough_leaf_costs(w, costs, Engine::simd);
          const auto least = std::min_element(rough.begin(), rough.end()) - rough.begin();
          double best = time_with(w, searched_leaves[0]);
          for (const int leaf : searched_leaves) best = std::min(best, time_with(w, leaf));
          CHECK(time_with(w, searched_leaves[static_cast<std::size_t>(least)]) <= 1.03 * best);
        }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no rays are refused") {
    CHECK_THROWS_AS(static_cast<void>(rough_leaf_costs(Workload{.rays = 0}, costs, Engine::simd)),
                    std::invalid_argument);
  }
}
