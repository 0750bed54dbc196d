#include "detp/sim/geometry/disc_box.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::support::unit_box;

namespace {

/// Whether one of many points of the disc lies in the box; never true if disc and box do not overlap.
bool sampled_overlap(const Disc& disc, const Box& box) {
  const auto [u, v] = basis_around(disc.normal);
  for (int i = 0; i <= 60; ++i)
    for (int j = 0; j < 60; ++j) {
      const double rho = disc.radius * i / 60.0;
      const double phi = 6.283185307179586 * j / 60.0;
      const glm::dvec3 p = disc.centre + rho * (std::cos(phi) * u + std::sin(phi) * v);
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis) inside = inside && p[axis] >= box.low[axis] && p[axis] <= box.high[axis];
      if (inside) return true;
    }
  return false;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a disc overlaps a box that holds its centre, touches its face, or is pierced by it") {
    CHECK(overlaps({{0.5, 0.5, 0.5}, {0, 0, 1}, 0.01}, unit_box, 0));
    CHECK(overlaps({{0.5, 0.5, 1}, {0, 0, 1}, 0.1}, unit_box, 0));
    CHECK(overlaps({{0.5, 0.5, 0.5}, {0, 0, 1}, 100}, unit_box, 0));
    CHECK(overlaps({{5, 0.5, 0.5}, {0, 1, 0}, 4.5}, unit_box, 0));
  }

  TEST_CASE("the disc may miss the box though their bounds overlap: beyond an edge, or in another plane") {
    CHECK_FALSE(overlaps({{1.08, 1.08, 0.5}, {0, 0, 1}, 0.1}, unit_box, 0));
    CHECK_FALSE(overlaps({{1.3, 1.3, 0.5}, glm::normalize(glm::dvec3{1, 1, 0}), 0.5}, unit_box, 0));
    CHECK_FALSE(overlaps({{5, 0.5, 0.5}, {0, 1, 0}, 3.9}, unit_box, 0));
  }

  TEST_CASE("the slack enlarges the box") {
    const Disc above{{0.5, 0.5, 1.05}, {0, 0, 1}, 0.1};
    CHECK_FALSE(overlaps(above, unit_box, 0.04));
    CHECK(overlaps(above, unit_box, 0.06));
  }

  TEST_CASE("bounds of a disc tilted by 1e-9 are not flat") {
    const Box box = bounds({{0, 0, 0}, {1e-9, 0, 1}, 2}, 0);
    CHECK(box.high.z == doctest::Approx(2e-9));
    CHECK(box.low.z == doctest::Approx(-2e-9));
  }

  TEST_CASE("bounds of an axis-aligned disc are flat") {
    const Box box = bounds({{1, 2, 3}, {0, 0, 1}, 0.5}, 0);
    CHECK(box.low == glm::dvec3{0.5, 1.5, 3});
    CHECK(box.high == glm::dvec3{1.5, 2.5, 3});
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("every overlap that points of the disc show is found, and few others are reported") {
    int overlapping = 0;
    int unconfirmed = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      const auto a = uniform4(31, Stream::tests, i);
      const auto b = uniform4(31, Stream::tests, i, 1);
      const Disc disc{{3 * a[0] - 1, 3 * a[1] - 1, 3 * a[2] - 1}, uniform_direction(b[0], b[1]), 0.1 + b[2]};
      const bool shown = sampled_overlap(disc, unit_box);
      const bool claimed = overlaps(disc, unit_box, 1e-12);
      if (shown) CHECK(claimed);
      overlapping += claimed ? 1 : 0;
      unconfirmed += claimed && !shown ? 1 : 0;
    }
    CHECK(overlapping > 500);
    CHECK(unconfirmed < overlapping / 50);
  }
}
