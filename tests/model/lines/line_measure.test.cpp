#include "detp/model/lines/line_measure.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using std::numbers::pi;

namespace {

/// Area common to two circles of radii a, b with distance c between centres, summed over strips across the line of
/// centres.
double lens_in_strips(double a, double b, double c) {
  constexpr int strips = 3000;
  const double reach = std::min(a, b);
  double area = 0;
  for (int i = 0; i < strips; ++i) {
    const double y = reach * ((i + 0.5) / strips);
    const double half_a = std::sqrt(std::max(0.0, a * a - y * y));
    const double half_b = std::sqrt(std::max(0.0, b * b - y * y));
    area += std::max(0.0, std::min(half_a, c + half_b) - std::max(-half_a, c - half_b));
  }
  return 2 * area * reach / strips;
}

/// both_hit_share by brute force: a sum over directions. Along a direction, the spheres project to circles.
double both_hit_share_in_strips(double a, double b, double c) {
  constexpr int directions = 1500;
  double sum = 0;
  for (int i = 0; i < directions; ++i) {
    const double angle = pi / 2 * (i + 0.5) / directions;
    sum += lens_in_strips(a, b, c * std::sin(angle)) * std::sin(angle);
  }
  return sum * pi / 2 / directions / (pi * b * b);
}

Workload in_cube() { return cube_workload(1000, 100, 0.05, 2); }

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("all lines that hit a sphere hit it; an inner sphere is hit by the share (r1/r0)²") {
    CHECK(sphere_hit_probability({2}, {2}) == 1);
    CHECK(sphere_hit_probability({1}, {2}) == 0.25);
    CHECK(sphere_hit_probability({3e-5}, {2e-4}) == Approx(0.0225).epsilon(1e-15));
  }

  TEST_CASE("a disc as large as its sphere stops half of the lines through the sphere, and a tiny one almost none") {
    CHECK(disc_hit_probability({2}, {2}) == 0.5);
    CHECK(disc_hit_probability({1}, {2}) == 0.125);
    CHECK(disc_hit_probability({1e-100}, {1}) < 1e-199);
  }

  TEST_CASE("lines meet a body with its surface over that of the sphere as probability, at most 1") {
    const Workload w = in_cube();
    const double r0 = w.sphere_radius;
    CHECK(crossing_probability(w, 4 * pi / 3, 4 * pi) == Approx(1 / (r0 * r0)).epsilon(1e-15));
    CHECK(crossing_probability(w, 1e9, 1e9) == 1);
    CHECK(crossing_probability(w, 0, 2 * pi * 0.05 * 0.05) ==
          Approx(disc_hit_probability({0.05}, {r0})).epsilon(1e-15));
  }

  TEST_CASE("segments of length zero meet a body by its volume, long ones by its surface") {
    Workload w = in_cube();
    const double space = std::pow(2.1, 3);
    w.path_length = 1e-300;
    CHECK(crossing_probability(w, 0.5, 4) == Approx(0.5 / space).epsilon(1e-14));
    w.path_length = 1.2;
    CHECK(crossing_probability(w, 0.5, 4) == Approx((0.5 + 1.2) / space).epsilon(1e-14));
    CHECK(crossing_probability(w, space, 0) == Approx(1).epsilon(1e-14));
    CHECK(crossing_probability(w, 2 * space, 0) == 1);
  }

  TEST_CASE("expected hits are rays times samples times the probability of a disc") {
    Workload w = in_cube();
    CHECK(expected_hits(w) == Approx(1e5 * disc_hit_probability({0.05}, {w.sphere_radius})).epsilon(1e-14));
    w.path_length = 1.5;
    CHECK(expected_hits(w) == Approx(1e5 * 1.5 * 2 * pi * 0.05 * 0.05 / 4 / std::pow(2.1, 3)).epsilon(1e-14));
  }

  TEST_CASE("if only fronts count, half of the hits are expected, of lines and of paths") {
    for (const double path_length : {0.0, 1.5}) {
      Workload both = in_cube();
      both.path_length = path_length;
      Workload fronts = both;
      fronts.front_facing = true;
      CHECK(expected_hits(fronts) == expected_hits(both) / 2);
    }
  }

  TEST_CASE("no line crosses the inner sphere and misses the outer one") {
    CHECK(both_hit_share(1, 1, 0) == 1);
    CHECK(both_hit_share(1, 0.5, 0.5) == 1);
    CHECK(both_hit_share(1, 0.25, 0.7) == 1);
  }

  TEST_CASE("with exchanged roles, the lines that cross both are the same") {
    for (const double a : {0.01, 0.3, 0.99, 1.0})
      for (const double c : {0.0, 0.1, 0.69, 0.7, 1.0, 1.3, 4.0, 50.0})
        CHECK(both_hit_share(a, 1, c) == Approx(a * a * both_hit_share(1, a, c)).epsilon(1e-8));
  }

  TEST_CASE("the share falls with the distance, grows with the other sphere, and does not depend on the unit") {
    for (const double b : {1e-6, 0.02, 0.5, 1.0, 2.5}) {
      double before = 1;
      for (double c = 0; c < 12; c += 0.03) {
        const double share = both_hit_share(1, b, c);
        CHECK(share <= before + 1e-9);
        CHECK(share > 0);
        CHECK(both_hit_share(1.1, b, c) >= share - 1e-9);
        CHECK(both_hit_share(1e9, b * 1e9, c * 1e9) == Approx(share).epsilon(1e-9));
        before = share;
      }
    }
  }

  TEST_CASE("far away, the share tends to that of the solid angle of the sphere: (a/c)²/2") {
    for (const double c : {30.0, 300.0, 1e5, 1e9})
      CHECK(both_hit_share(1, 1e-3, c) == Approx(0.5 / (c * c)).epsilon(1.0 / (c * c) + 1e-6));
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("the share of lines through both spheres agrees with that of circles cut in strips" *
            doctest::test_suite("long")) {
    for (const double b : {0.05, 0.4, 1.0, 2.5})
      for (const double c : {0.3, 0.97, 1.7, 9.0}) {
        INFO("b ", b, ", c ", c);
        CHECK(std::abs(both_hit_share(1, b, c) - both_hit_share_in_strips(1, b, c)) < 2e-6);
      }
  }

  TEST_CASE("a point's share is the part of the sky that the sphere covers: 1 - √(1 - 1/c²)") {
    for (const double c : {1.001, 1.1, 1.7, 5.0, 40.0}) {
      const double expected = 1 - std::sqrt(1 - 1 / (c * c));
      CHECK(std::abs(both_hit_share(1, 1e-7, c) - expected) < 1e-6);
      CHECK(std::abs(both_hit_share(1, 1e-5, c) - expected) < 1e-6);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid radius is refused by name") {
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)sphere_hit_probability({bad}, {1}), Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)sphere_hit_probability({1}, {bad}), Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)disc_hit_probability({bad}, {1}), Contains("disc radius must be > 0 and finite"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)disc_hit_probability({1}, {bad}), Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)both_hit_share(bad, 1, 1), Contains("sphere radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)both_hit_share(1, bad, 1), Contains("sphere radius"), std::invalid_argument);
    }
    for (const double bad : support::not_a_size)
      CHECK_THROWS_WITH_AS((void)both_hit_share(1, 1, bad), Contains("distance of the centres"), std::invalid_argument);
  }

  TEST_CASE("a body that extends outside its sphere is refused by name") {
    CHECK_THROWS_WITH_AS((void)sphere_hit_probability({1.0001}, {1}), Contains("inner sphere radius"),
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)disc_hit_probability({1.0001}, {1}), Contains("disc radius"), std::invalid_argument);
  }

  TEST_CASE("a workload or a body out of range is refused by name") {
    for (const double bad : support::not_a_count) {
      Workload w = in_cube();
      w.rays = bad;
      CHECK_THROWS_WITH_AS((void)crossing_probability(w, 1, 1), Contains("number of rays"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)expected_hits(w), Contains("number of rays"), std::invalid_argument);
    }
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)crossing_probability(in_cube(), bad, 1), Contains("volume"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)crossing_probability(in_cube(), 1, bad), Contains("area"), std::invalid_argument);
    }
  }
}
