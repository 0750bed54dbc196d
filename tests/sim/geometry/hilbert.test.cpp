#include "detp/sim/geometry/hilbert.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::support::unit_box;

namespace {

using Cell = std::array<std::int64_t, 3>;

struct Place {
  std::uint64_t code;
  Cell cell;
};

/// The cells of a cube with 2^levels cells along a side and the low corner `low`, in the order of the curve. `cell` is
/// the side of a cell in a box of side 1.
std::vector<Place> along_curve(const Cell& low, int levels, double cell) {
  std::vector<Place> places;
  const std::int64_t side = std::int64_t{1} << levels;
  for (std::int64_t x = 0; x < side; ++x)
    for (std::int64_t y = 0; y < side; ++y)
      for (std::int64_t z = 0; z < side; ++z) {
        const Cell at{low[0] + x, low[1] + y, low[2] + z};
        const glm::dvec3 corner = cell * glm::dvec3{at[0], at[1], at[2]};
        places.push_back({hilbert_code(corner + 0.5 * cell, unit_box), at});
      }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.code < b.code; });
  return places;
}

std::int64_t steps_between(const Cell& a, const Cell& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("at every size each cell has its own place on the curve and shares a face with the next") {
    for (int levels = 1; levels <= 5; ++levels) {
      const int below = 3 * (16 - levels);  // bits of the code within a cell
      const auto places = along_curve({0, 0, 0}, levels, std::ldexp(1.0, -levels));
      for (std::size_t i = 0; i < places.size(); ++i) {
        REQUIRE((places[i].code >> below) == i);
        if (i > 0) REQUIRE(steps_between(places[i - 1].cell, places[i].cell) == 1);
      }
    }
  }

  TEST_CASE("the smallest cells fill each cube of 16 a side consecutively, each sharing a face with the next") {
    for (std::uint64_t i = 0; i < 20; ++i) {
      const auto words = bits4(3, Stream::tests, i);
      Cell low{};
      for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = 16 * static_cast<std::int64_t>(words[axis] % 4096);
      const auto places = along_curve(low, 4, std::ldexp(1.0, -16));
      CHECK(places.front().code % 4096 == 0);
      for (std::size_t j = 1; j < places.size(); ++j) {
        REQUIRE(places[j].code == places[j - 1].code + 1);
        REQUIRE(steps_between(places[j - 1].cell, places[j].cell) == 1);
      }
    }
  }

  TEST_CASE("the curve goes from one half of the box to the next through a common face of two of the smallest cells") {
    std::vector<Place> corners;  // corners of the octants: the curve enters and leaves an octant at its corners
    for (std::int64_t x : {0, 32767, 32768, 65535})
      for (std::int64_t y : {0, 32767, 32768, 65535})
        for (std::int64_t z : {0, 32767, 32768, 65535})
          corners.push_back({hilbert_code((glm::dvec3{x, y, z} + 0.5) / 65536.0, unit_box), {x, y, z}});
    int joints = 0;
    for (const Place& last : corners)
      for (const Place& first : corners)
        if (first.code == last.code + 1) {
          CHECK(first.code % (1ULL << 45) == 0);
          CHECK(steps_between(first.cell, last.cell) == 1);
          ++joints;
        }
    CHECK(joints == 7);
  }

  TEST_CASE("the order is the stable sort by code") {
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < 3000; ++i) {
      const auto u = uniform4(4, Stream::tests, i % 2500);  // the last 500 repeat the first
      points.emplace_back(u[0], 2 * u[1], u[2]);
    }
    Box box;
    for (const glm::dvec3& point : points) box.include(point);
    std::vector<std::uint32_t> expected(points.size());
    for (std::uint32_t i = 0; i < expected.size(); ++i) expected[i] = i;
    std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
      return hilbert_code(points[a], box) < hilbert_code(points[b], box);
    });
    CHECK(hilbert_order(points) == expected);
    CHECK(hilbert_order({}).empty());
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the curve starts at the low corner, and points outside belong to the nearest cell") {
    CHECK(hilbert_code({0, 0, 0}, unit_box) == 0);
    CHECK(hilbert_code({-1, -1, -1}, unit_box) == 0);
    CHECK(hilbert_code({9, 9, 9}, unit_box) == hilbert_code({1, 1, 1}, unit_box));
    CHECK(hilbert_code({5, 5, 5}, {{5, 5, 5}, {5, 5, 5}}) == 0);
  }
}
