#include "detp/model/disc_index/disc_index.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "support/not_a_length.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using support::few_rays;

namespace {}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a root alone is one node with all references") {
    CHECK(octree_bytes(few_rays, {0}) == 12 + 4e5);
    CHECK(grid_bytes(few_rays, {1}) == 16 + 4e5);
    CHECK(octree_bytes(few_rays, {0}, {}, {.node = 100, .reference = 8}) == 100 + 8e5);
  }

  TEST_CASE("a full octree has (8^(k+1) - 1)/7 nodes, a grid 8^k cells and one more") {
    Workload w = few_rays;
    w.samples = 1e15;
    for (int depth = 0; depth <= 4; ++depth) {
      CHECK(octree_bytes(w, {depth}, {}, {.node = 1, .reference = 0}) ==
            Approx((std::pow(8, depth + 1) - 1) / 7).epsilon(1e-12));
      CHECK(grid_bytes(w, {1 << depth}, {}, {.cell = 1, .reference = 0}) == std::pow(8, depth) + 1);
    }
  }

  TEST_CASE("references equal those of the counts") {
    for (const auto insertion : {Insertion::exact, Insertion::bounding_box}) {
      const IndexVariant variant{.insertion = insertion};
      CHECK(octree_bytes(few_rays, {5}, variant, {.node = 0, .reference = 1}) ==
            Approx(octree_counts(few_rays, {5}, variant).references).epsilon(1e-14));
      CHECK(grid_bytes(few_rays, {50}, variant, {.cell = 0, .reference = 1}) ==
            Approx(grid_counts(few_rays, {50}, variant).references).epsilon(1e-14));
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range are refused by name") {
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)octree_bytes(few_rays, {1}, {}, {.node = bad}), Contains("node"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)grid_bytes(few_rays, {1}, {}, {.cell = bad}), Contains("cell"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)grid_bytes(few_rays, {1}, {}, {.reference = bad}), Contains("reference"),
                           std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS((void)octree_bytes(few_rays, {301}), Contains("depth"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)grid_bytes(few_rays, {0}), Contains("cells a side"), std::invalid_argument);
  }
}
