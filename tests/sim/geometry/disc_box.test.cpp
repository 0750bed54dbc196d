#include "detp/sim/geometry/disc_box.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "detp/sim/geometry/closest_point.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/geometry/triangle_in_sphere.hpp"
#include "detp/sim/geometry/turn.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::sim::dominant_axis;
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

constexpr double tilt = 0.6;  // (0.6, 0, 0.8) is a unit vector
const Disc floor_disc{{0, 0, 0}, {0, 0, 1}, 1};

Ray line(const glm::dvec3& through, const glm::dvec3& direction) {
  return {.origin = through, .direction = glm::normalize(direction)};
}

Ray segment(const glm::dvec3& from, const glm::dvec3& to) {
  return {.origin = from, .direction = glm::normalize(to - from), .length = glm::distance(from, to)};
}

/// The textbook method: intersects the line with the plane, and compares the distance from the centre with the radius.
bool crosses(const Ray& ray, const Disc& disc) {
  const double facing = glm::dot(disc.normal, ray.direction);
  const double t = glm::dot(disc.normal, disc.centre - ray.origin) / facing;
  if (!ray.is_line() && (t < 0 || t > ray.length)) return false;
  return glm::distance(ray.origin + t * ray.direction, disc.centre) <= disc.radius;
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

  TEST_CASE("the axis of the largest component, of either sign; if two are equal the lower axis") {
    CHECK(dominant_axis({0.8, -0.6, 0}) == 0);
    CHECK(dominant_axis({0.6, -0.8, 0}) == 1);
    CHECK(dominant_axis({0.1, 0.2, -0.9}) == 2);
    CHECK(dominant_axis({-0.5, 0.5, 0.5}) == 0);
    CHECK(dominant_axis({0, -0.5, 0.5}) == 1);
    CHECK(dominant_axis({0.5, 0, -0.5}) == 0);
  }

  TEST_CASE("an eighth of a turn and its multiples") {
    CHECK(turn(0).cos == 1);
    CHECK(turn(0).sin == 0);
    CHECK(turn(0.25).cos == 0);
    CHECK(turn(0.25).sin == 1);
    CHECK(turn(0.5).cos == -1);
    CHECK(turn(0.5).sin == 0);
    CHECK(turn(0.75).cos == 0);
    CHECK(turn(0.75).sin == -1);
    for (const double share : {0.125, 0.375, 0.625, 0.875}) {
      CHECK(std::abs(turn(share).cos) == doctest::Approx(std::sqrt(0.5)).epsilon(1e-15));
      CHECK(std::abs(turn(share).sin) == doctest::Approx(std::sqrt(0.5)).epsilon(1e-15));
    }
  }

  TEST_CASE("a line through the disc hits it from both sides and from far away") {
    CHECK(hits(line({0.5, 0.5, -7}, {0, 0, 1}), floor_disc));
    CHECK(hits(line({0.5, 0.5, 7}, {0, 0, 1}), floor_disc));
    CHECK(hits(line({0, 0, 0}, {tilt, 0, 0.8}), floor_disc));
    CHECK_FALSE(hits(line({0.8, 0.8, 0}, {0, 0, 1}), floor_disc));
  }

  TEST_CASE("the rim belongs to the disc") {
    CHECK(hits(line({1, 0, -3}, {0, 0, 1}), floor_disc));
    CHECK_FALSE(hits(line({std::nextafter(1.0, 2.0), 0, -3}, {0, 0, 1}), floor_disc));
  }

  TEST_CASE("a ray in or along the plane does not hit") {
    CHECK_FALSE(hits(line({0, 0, 0}, {1, 0, 0}), floor_disc));
    CHECK_FALSE(hits(line({0, 0, 0.1}, {1, 0, 0}), floor_disc));
  }

  TEST_CASE("a segment hits only between its ends, ends included") {
    CHECK(hits(segment({0, 0, -1}, {0, 0, 1}), floor_disc));
    CHECK(hits(segment({0, 0, 0}, {0, 0, 1}), floor_disc));
    CHECK(hits(segment({0, 0, 1}, {0, 0, 0}), floor_disc));
    CHECK_FALSE(hits(segment({0, 0, 0.001}, {0, 0, 1}), floor_disc));
    CHECK_FALSE(hits(segment({0, 0, -1}, {0, 0, -0.001}), floor_disc));
  }

  TEST_CASE("a ray arrives at the front if it runs against the normal") {
    CHECK(arrives_in_front(line({0, 0, 1}, {0, 0, -1}), floor_disc));
    CHECK_FALSE(arrives_in_front(line({0, 0, -1}, {0, 0, 1}), floor_disc));
  }

  TEST_CASE("a sphere is met by a line that touches it, and by a segment that ends or lies in it") {
    const Sphere ball{{0, 0, 0}, 1};
    CHECK(hits(line({1, 0, -5}, {0, 0, 1}), ball));
    CHECK_FALSE(hits(line({1.001, 0, -5}, {0, 0, 1}), ball));
    CHECK(hits(segment({0, 0, -5}, {0, 0, -0.9}), ball));
    CHECK(hits(segment({0.1, 0, 0}, {0.2, 0, 0}), ball));
    CHECK_FALSE(hits(segment({0, 0, -5}, {0, 0, -1.1}), ball));
    CHECK_FALSE(hits(segment({0, 0, 1.1}, {0, 0, 5}), ball));
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

  TEST_CASE("cosine and sine are wrong by less than 3e-16") {
    static_assert(std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits);
    long double worst = 0;
    const auto compare = [&](double share) {
      const long double angle = 2 * std::numbers::pi_v<long double> * share;
      const Turn one = turn(share);
      worst = std::max({worst, std::abs(one.cos - std::cos(angle)), std::abs(one.sin - std::sin(angle))});
    };
    for (std::uint64_t i = 0; i < 5000; ++i)
      for (const double share : uniform4(7, Stream::tests, i)) compare(share);
    for (int eighth = 0; eighth < 8; ++eighth)
      for (const double beside : {0.0, 0x1p-53, 0x1p-40}) compare(eighth / 8.0 + beside);
    for (int eighth = 1; eighth <= 8; ++eighth) compare(eighth / 8.0 - 0x1p-53);
    CHECK(worst < 3e-16L);
  }

  TEST_CASE("deciding without division agrees with the textbook method, except within rounding of the rim") {
    int hit = 0;
    for (std::uint64_t i = 0; i < 100'000; ++i) {
      const auto a = uniform4(21, Stream::tests, i);
      const auto b = uniform4(21, Stream::tests, i, 1);
      const Disc disc{{}, uniform_direction(a[0], a[1]), 0.5};
      Ray ray{.origin = {2 * a[2] - 1, 2 * a[3] - 1, 2 * b[0] - 1}, .direction = uniform_direction(b[1], b[2])};
      if (i % 2 == 0) ray.length = 2 * b[3];
      hit += hits(ray, disc) ? 1 : 0;
      CHECK(hits(ray, disc) == crosses(ray, disc));
    }
    CHECK(hit > 5'000);  // both answers occurred
  }
}

namespace detp::sim {
namespace {

using std::numbers::pi;

glm::dvec3 random_point(std::uint64_t number, double size) {
  const auto uniform = uniform4(5, Stream::tests, number);
  return size * (2.0 * glm::dvec3(uniform[0], uniform[1], uniform[2]) - 1.0);
}

}  // namespace

TEST_SUITE("triangle in a sphere") {
  TEST_CASE("known answers: all, nothing, the circle, a half, a quarter") {
    const glm::dvec3 a(-100, -100, 0.6);
    const glm::dvec3 b(100, -100, 0.6);
    const glm::dvec3 c(0, 100, 0.6);
    CHECK(area_in_sphere(a, b, c, 1) == doctest::Approx(pi * 0.64).epsilon(1e-12));
    CHECK(area_in_sphere(a, b, c, 0.6) == 0);
    CHECK(area_in_sphere(a, b, c, 1000) == doctest::Approx(0.5 * 200 * 200).epsilon(1e-14));
    CHECK(area_in_sphere({-100, 0, 0}, {100, 0, 0}, {0, 100, 0}, 2) == doctest::Approx(2 * pi).epsilon(1e-12));
    CHECK(area_in_sphere({0, 0, 0}, {100, 0, 0}, {0, 100, 0}, 2) == doctest::Approx(pi).epsilon(1e-12));
    CHECK(area_in_sphere({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, 2) == 0);
    CHECK(area_in_sphere({5, 0, 0}, {6, 0, 0}, {6, 1, 0}, 2) == 0);
  }

  TEST_CASE("the parts of a triangle that is cut in three add up to it, whatever the order of the corners") {
    for (std::uint64_t i = 0; i < 20'000; ++i) {
      const glm::dvec3 a = random_point(4 * i, 2);
      const glm::dvec3 b = random_point(4 * i + 1, 2);
      const glm::dvec3 c = random_point(4 * i + 2, 2);
      const auto weights = uniform4(6, Stream::tests, i);
      const double sum = weights[0] + weights[1] + weights[2];
      const glm::dvec3 inside = (weights[0] * a + weights[1] * b + weights[2] * c) / sum;
      const double whole = area_in_sphere(a, b, c, 1);
      const double parts =
          area_in_sphere(a, b, inside, 1) + area_in_sphere(b, c, inside, 1) + area_in_sphere(c, a, inside, 1);
      CHECK(std::abs(whole - parts) < 1e-12);
      CHECK(std::abs(whole - area_in_sphere(c, b, a, 1)) < 1e-12);
    }
  }

  TEST_CASE("hard cases: slivers and huge triangles, against the strip and the half plane") {
    // A strip of width w through the centre has the area 2 (x √(1 - x²) + asin x), x = w/2 (radius 1).
    for (const double width : {1e-9, 1e-6, 1e-3, 0.1}) {
      const double half = 0.5 * width;
      const double strip = 2 * (half * std::sqrt(1 - half * half) + std::asin(half));
      const double found = area_in_sphere({-3, -half, 0}, {3, -half, 0}, {3, half, 0}, 1) +
                           area_in_sphere({-3, -half, 0}, {3, half, 0}, {-3, half, 0}, 1);
      CHECK(found == doctest::Approx(strip).epsilon(1e-12));
    }
    CHECK(area_in_sphere({-1e8, 0, 0}, {1e8, 0, 0}, {0, 1e8, 0}, 1) == doctest::Approx(0.5 * pi).epsilon(1e-7));
  }

  TEST_CASE("the closest point: no point of a grid over the triangle is nearer, and it lies in the triangle") {
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const glm::dvec3 a = random_point(4 * i, 2);
      const glm::dvec3 b = random_point(4 * i + 1, 2);
      const glm::dvec3 c = i % 10 == 0 ? 0.5 * (a + b) : random_point(4 * i + 2, 2);
      const glm::dvec3 weights = closest_point_weights(a, b, c);
      CHECK(std::min({weights.x, weights.y, weights.z}) >= 0);
      CHECK(weights.x + weights.y + weights.z == doctest::Approx(1).epsilon(1e-14));
      const double least = glm::length(weights.x * a + weights.y * b + weights.z * c);
      constexpr int steps = 20;
      for (int x = 0; x <= steps; ++x)
        for (int y = 0; x + y <= steps; ++y) {
          const glm::dvec3 point =
              (double(x) * a + double(y) * b + double(steps - x - y) * c) / static_cast<double>(steps);
          CHECK(least <= glm::length(point) + 1e-12);
        }
    }
  }
}

}  // namespace detp::sim
