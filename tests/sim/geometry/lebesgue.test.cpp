#include "detp/sim/geometry/curve.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::support::unit_box;

namespace {

std::vector<glm::dvec3> random_points(std::size_t count) {
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto u = uniform4(4, Stream::tests, i);
    points.emplace_back(u[0], u[1], u[2]);
  }
  return points;
}

Box box_of(const std::vector<glm::dvec3>& points) {
  Box box;
  for (const glm::dvec3& point : points) box.include(point);
  return box;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("X is more significant than Y and Y than Z, the highest bits first") {
    const double half = 0.5;
    CHECK(lebesgue_code({half, 0, 0}, unit_box) == 1ULL << 47);
    CHECK(lebesgue_code({0, half, 0}, unit_box) == 1ULL << 46);
    CHECK(lebesgue_code({0, 0, half}, unit_box) == 1ULL << 45);
    CHECK(lebesgue_code({1.0 / 65536, 0, 0}, unit_box) == 4);
    CHECK(lebesgue_code({0, 1.0 / 65536, 0}, unit_box) == 2);
    CHECK(lebesgue_code({0, 0, 1.0 / 65536}, unit_box) == 1);
    CHECK(lebesgue_code({1, 1, 1}, unit_box) == (1ULL << 48) - 1);
  }

  TEST_CASE("bits are interleaved as a loop over them does") {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const auto words = bits4(8, Stream::tests, i);
      std::uint64_t expected = 0;
      glm::dvec3 point;
      for (int axis = 0; axis < 3; ++axis) {
        const std::uint64_t coordinate = words[static_cast<std::size_t>(axis)] & 0xffff;
        point[axis] = (static_cast<double>(coordinate) + 0.5) / 65536;
        for (int bit = 0; bit < 16; ++bit) expected |= (coordinate >> bit & 1) << (3 * bit + 2 - axis);
      }
      CHECK(lebesgue_code(point, unit_box) == expected);
    }
  }

  TEST_CASE("points outside the box belong to the nearest cell, and a box without extent is one cell") {
    CHECK(lebesgue_code({-1, -1, -1}, unit_box) == 0);
    CHECK(lebesgue_code({9, 9, 9}, unit_box) == (1ULL << 48) - 1);
    CHECK(lebesgue_code({5, 5, 5}, {{5, 5, 5}, {5, 5, 5}}) == 0);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the order is the stable sort by code") {
    std::vector<glm::dvec3> points = random_points(20'000);
    for (std::size_t i = 0; i < 5'000; ++i) points.push_back(points[i]);  // ties
    const Box box = box_of(points);
    std::vector<std::uint32_t> expected(points.size());
    for (std::uint32_t i = 0; i < expected.size(); ++i) expected[i] = i;
    std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
      return lebesgue_code(points[a], box) < lebesgue_code(points[b], box);
    });
    CHECK(lebesgue_order(points) == expected);
  }

  TEST_CASE("no, one and equal points keep their order") {
    CHECK(lebesgue_order({}).empty());
    const std::vector<glm::dvec3> same(3, glm::dvec3{1, 2, 3});
    CHECK(lebesgue_order(same) == std::vector<std::uint32_t>{0, 1, 2});
  }
}
