#include "detp/sim/geometry/predicates.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;

namespace {

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
