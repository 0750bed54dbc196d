#include "detp/model/hierarchy/box_tree_expected.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace detp::model::box_tree;
using doctest::Approx;

namespace {

struct Total {
  double inner = 0;
  double leaves = 0;
  double discs = 0;
};

Total total(int dimension, double samples, double radius, int leaf) {
  Total sum;
  for (const LevelNodes& level : expected_binary_tree(dimension, samples, radius, leaf)) {
    sum.inner += level.inner.count;
    for (const Leaves& leaves : level.leaves) {
      sum.leaves += leaves.count;
      sum.discs += leaves.count * leaves.discs;
    }
  }
  return sum;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the leaves hold all samples, and there is one more of them than of inner nodes") {
    for (const int dimension : {2, 3})
      for (const double samples : {300.0, 5000.0, 3e5})
        for (const double radius : {1e-4, 1e-2, 0.1})
          for (const int leaf : {1, 2, 7, 31, 64, 100}) {
            const Total sum = total(dimension, samples, radius, leaf);
            CAPTURE(dimension);
            CAPTURE(samples);
            CAPTURE(radius);
            CAPTURE(leaf);
            CHECK(sum.discs == Approx(samples).epsilon(0.03));
            CHECK(sum.leaves == Approx(sum.inner + 1).epsilon(0.05));
          }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("each point has its leaf if leaves hold one; of discs larger than the cube, 64 share a leaf") {
    CHECK(total(3, 1e4, 1e-9, 1).leaves == Approx(1e4).epsilon(0.03));
    const Total large = total(3, 1e4, 10, 1);
    CHECK(large.discs / large.leaves == Approx(48).epsilon(0.35));
  }
}
