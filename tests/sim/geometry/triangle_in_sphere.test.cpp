#include "detp/sim/geometry/triangle_in_sphere.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "detp/sim/geometry/closest_point.hpp"
#include "detp/sim/geometry/random.hpp"

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
