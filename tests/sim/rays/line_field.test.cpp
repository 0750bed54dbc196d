#include "detp/sim/rays/line_field.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "support/machine.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

bool same_bytes(const std::vector<Ray>& a, const std::vector<Ray>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Ray)) == 0;
}

std::vector<Ray> read_in_blocks(const RaySource& source, std::size_t block) {
  std::vector<Ray> all(source.size());
  for (std::size_t first = 0; first < all.size(); first += block)
    source.read(first, std::span(all).subspan(first, std::min(block, all.size() - first)));
  return all;
}

const Sphere sphere{{1, -2, 3}, 2.5};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("a line has unit direction, is unbounded, starts nearest to the centre and crosses the sphere") {
    const Sphere sphere{{3, -2, 5}, 0.7};
    for (const Ray& line : LineField(sphere, 11).lines(0, 1000)) {
      CHECK(std::abs(glm::length(line.direction) - 1) < 4e-16);
      CHECK(line.is_line());
      CHECK(std::abs(glm::dot(line.origin - sphere.centre, line.direction)) < 1e-15);
      CHECK(glm::distance(line.origin, sphere.centre) <= sphere.radius);
    }
  }

  TEST_CASE("line i is the same however many lines are made, and another seed gives another") {
    const LineField field({}, 5);
    const auto lines = field.lines(10, 5);
    CHECK(lines[3].origin == field.line(13).origin);
    CHECK(LineField({}, 6).line(13).origin != field.line(13).origin);
  }

  TEST_CASE("lines made together are the same bits as one made alone, with every instruction set") {
    const LineField field({{3, -2, 5}, 0.7}, 5);
    support::with_each_instruction_set([&] {
      for (const std::size_t count : {1, 7, 64, 65, 1000}) {
        const auto lines = field.lines(3, count);
        for (std::size_t i = 0; i < count; ++i) {
          const Ray line = field.line(3 + i);
          REQUIRE(lines[i].origin == line.origin);
          REQUIRE(lines[i].direction == line.direction);
          REQUIRE(lines[i].length == line.length);
          REQUIRE(lines[i].power == line.power);
        }
      }
    });
  }

  TEST_CASE("a basis is orthonormal and right-handed for any axis, including the poles") {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const auto u = uniform4(3, Stream::tests, i);
      const glm::dvec3 axis =
          i == 0 ? glm::dvec3{0, 0, 1} : (i == 1 ? glm::dvec3{0, 0, -1} : uniform_direction(u[0], u[1]));
      const auto [first, second] = basis_around(axis);
      CHECK(glm::distance(glm::cross(first, second), axis) < 1e-14);
      CHECK(std::abs(glm::dot(first, second)) < 1e-15);
      CHECK(std::abs(glm::length(first) - 1) < 1e-14);
    }
  }

  TEST_CASE("the lines of a field are its lines, for any blocks") {
    const std::vector<Ray> lines = LineField(sphere, 7).lines(0, 10'000);
    const LinesOfField source(sphere, 7, lines.size());
    CHECK(source.size() == lines.size());
    for (const std::size_t block : {997, 5000, 10'000}) CHECK(same_bytes(read_in_blocks(source, block), lines));
    CHECK_FALSE(same_bytes(read_in_blocks(LinesOfField(sphere, 8, lines.size()), 997), lines));
  }

  TEST_CASE("rays in memory are read unchanged") {
    const std::vector<Ray> lines = LineField(sphere, 7).lines(0, 100);
    for (const std::size_t block : {1, 7, 100}) CHECK(same_bytes(read_in_blocks(RaysInMemory(lines), block), lines));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid sphere is refused by name") {
    for (const double bad :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
      CHECK_THROWS_WITH_AS(LineField({{}, bad}, 1), doctest::Contains("sphere radius must be > 0"),
                           std::invalid_argument);
    CHECK_THROWS_WITH_AS(LineField({{std::nan(""), 0, 0}, 1}, 1), doctest::Contains("sphere centre"),
                         std::invalid_argument);
  }
}

TEST_SUITE("statistical") {
  // Of uniform isotropic lines, the share (r1/r0)² crosses an inner sphere wherever the sphere lies. A field that is
  // not invariant under translation (such as lines through two random points in the ball) fails this test at some
  // place.
  TEST_CASE("an inner sphere is hit equally often at the centre and at the rim") {
    constexpr int lines = 400'000;
    constexpr double radius = 0.3;
    constexpr double p = radius * radius;
    const double sigma = std::sqrt(p * (1 - p) / lines);
    const LineField field({}, 77);
    for (const double place : {0.0, 0.35, 0.7}) {
      int hit = 0;
      const Sphere inner{place * uniform_direction(0.3, 0.8), radius};
      for (int i = 0; i < lines; ++i) hit += hits(field.line(static_cast<std::uint64_t>(i)), inner) ? 1 : 0;
      const double share = static_cast<double>(hit) / lines;
      CHECK_MESSAGE(std::abs(share - p) < 5 * sigma, "place ", place, ": share ", share, ", expected ", p);
      CHECK_MESSAGE(std::abs(share - 1.05 * p) > 5 * sigma, "negative control: 5 % off must be seen");
    }
  }

  TEST_CASE("cosine directions have mean cosine 2/3, uniform ones 1/2 over the hemisphere") {
    constexpr int count = 200'000;
    const glm::dvec3 axis = uniform_direction(0.2, 0.4);
    double cosine = 0;
    double uniform = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto u = uniform4(9, Stream::tests, i);
      cosine += glm::dot(axis, cosine_direction(axis, u[0], u[1]));
      uniform += std::abs(glm::dot(axis, uniform_direction(u[2], u[3])));
    }
    // Standard deviations of the cosine: sqrt(1/2 - 4/9) and sqrt(1/3 - 1/4).
    CHECK(std::abs(cosine / count - 2.0 / 3) < 5 * std::sqrt(1.0 / 18 / count));
    CHECK(std::abs(uniform / count - 0.5) < 5 * std::sqrt(1.0 / 12 / count));
  }
}

TEST_SUITE("limit") {
  TEST_CASE("no origin is farther than farthest_from reports, and that bound is tight") {
    const std::vector<Ray> lines = LineField(sphere, 7).lines(0, 10'000);
    for (const glm::dvec3& point : {sphere.centre, glm::dvec3{0, 0, 0}, glm::dvec3{10, 10, 10}}) {
      double farthest = 0;
      for (const Ray& line : lines) farthest = std::max(farthest, glm::distance(line.origin, point));
      CHECK(RaysInMemory(lines).farthest_from(point) == farthest);
      const double reported = LinesOfField(sphere, 7, lines.size()).farthest_from(point);
      CHECK(reported >= farthest);
      CHECK(reported < 1.01 * farthest);
    }
  }
}
