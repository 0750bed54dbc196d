#include "detp/model/disc_index/disc_index_published.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;

namespace {

const Workload some = {.rays = 1000, .samples = 100, .disc_radius = 0.01, .sphere_radius = 1, .box = {1, 1, 1}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("cells as wide as a disc are accepted; if one ulp narrower, the next larger ones are used") {
    for (int depth = 0; depth <= 300; ++depth)
      for (const double side : {2.0, 1.0, 0.7, 3e5}) {
        const double d = std::ldexp(side, -depth - 1);
        CHECK(published::octree_depth({d}, side) == depth);
        CHECK(published::octree_depth({std::nextafter(d, 1e9)}, side) == std::max(0, depth - 1));
        CHECK(published::octree_depth({std::nextafter(d, 0.0)}, side) == depth);
      }
  }

  TEST_CASE("the paper's scene of side 2: k = floor(-log2 d)") {
    CHECK(published::octree_depth({0.25}, 2) == 2);
    CHECK(published::octree_depth({0.01}, 2) == 6);
    CHECK(published::octree_depth({1}, 2) == 0);
  }

  TEST_CASE("discs wider than the scene need no level; the smallest double is a valid disc radius") {
    CHECK(published::octree_depth({1e300}, 1e-300) == 0);
    CHECK(published::octree_depth({std::numeric_limits<double>::denorm_min()}, 1) == 1073);
  }

  TEST_CASE("depth 4 of 1000 rays and 100 discs") {
    CHECK(published::cells_per_line(4) == 16);
    CHECK(published::discs_per_cell(100, 4) == 100 / 4096.0);
    CHECK(published::tests_per_line(100, 4) == 100 / 256.0);
    CHECK(published::balanced_octree_time(some, 4, 2) == 781.25);
    CHECK(published::octree_time(some, 4, 2) == 3125);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid length is refused by name") {
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)published::octree_depth({bad}, 1), Contains("disc radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::octree_depth({1}, bad), Contains("scene side"), std::invalid_argument);
    }
  }

  TEST_CASE("a depth, a number of samples or a workload out of range is refused by name") {
    for (const int bad : {-1, 2097}) {
      CHECK_THROWS_WITH_AS((void)published::cells_per_line(bad), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::discs_per_cell(1, bad), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::tests_per_line(1, bad), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::octree_time(some, bad, 1), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::balanced_octree_time(some, bad, 1), Contains("depth"),
                           std::invalid_argument);
    }
    for (const double bad : support::not_a_count) {
      Workload w = some;
      w.samples = bad;
      const Contains name("number of samples");
      CHECK_THROWS_WITH_AS((void)published::discs_per_cell(bad, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::tests_per_line(bad, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::octree_time(w, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::balanced_octree_time(w, 1, 1), name, std::invalid_argument);
    }
  }

  TEST_CASE("an invalid time of a test is refused by name") {
    for (const double bad : support::not_a_size) {
      const Contains name("time of a ray-disc test");
      CHECK_THROWS_WITH_AS((void)published::octree_time(some, 1, bad), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::balanced_octree_time(some, 1, bad), name, std::invalid_argument);
    }
  }
}
