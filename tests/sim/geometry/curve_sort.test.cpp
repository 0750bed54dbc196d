#include "detp/sim/geometry/curve_sort.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/geometry/hilbert.hpp"
#include "detp/sim/geometry/random.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using namespace detp::sim::stream;
using detp::support::unit_box;

namespace {

/// Discs of which half are crowded together near a corner, some of them at the same place.
std::vector<Disc> crowded_discs(std::size_t count) {
  std::vector<Disc> discs(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto u = uniform4(9, Stream::tests, i % 3 == 0 ? i / 7 : i);
    const double side = i % 2 == 0 ? 1 : 1e-3;
    discs[i].centre = side * glm::dvec3{u[0], u[1], u[2]};
  }
  return discs;
}

Box box_around_centres(const std::vector<Disc>& discs) {
  Box box;
  for (const Disc& disc : discs) box.include(disc.centre);
  return box;
}

std::uint32_t code_bit_by_bit(const glm::dvec3& point, const Box& box, int bits) {
  const double cells = std::ldexp(1.0, bits);
  std::uint32_t code = 0;
  if (box.longest_side() == 0) return code;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = (point[axis] - box.low[axis]) * (cells / box.longest_side());
    const auto cell = static_cast<std::uint32_t>(std::min(along, cells - 1));
    for (int bit = 0; bit < bits; ++bit) code |= (cell >> bit & 1) << (3 * bit + 2 - axis);
  }
  return code;
}

CurvePlaces sorted_by_the_library(const std::vector<Disc>& discs) {
  const Box box = box_around_centres(discs);
  CurvePlaces places;
  for (std::size_t i = 0; i < discs.size(); ++i)
    places.push_back(CurvePlace{code_bit_by_bit(discs[i].centre, box, discs.size() < 8192 ? 6 : 10)} << 32 | i);
  std::sort(places.begin(), places.end());
  return places;
}

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

TEST_SUITE("identity") {
  TEST_CASE("discs are sorted by their cells along the curve, in a cell by their numbers") {
    for (const std::size_t count : {1, 2, 100, 8191, 8192, 70'000}) {
      CAPTURE(count);
      const auto discs = crowded_discs(count);
      CHECK(sort_along_curve(discs, box_around_centres(discs)) == sorted_by_the_library(discs));
    }
  }

  TEST_CASE("only discs that are together in one cell of the curve, and few, may stay unsorted") {
    constexpr std::size_t unsorted = 16;
    for (const std::size_t count : {100, 8191, 70'000}) {
      CAPTURE(count);
      const auto discs = crowded_discs(count);
      const CurvePlaces sorted = sorted_by_the_library(discs);
      CurvePlaces places = sort_along_curve(discs, box_around_centres(discs), unsorted);
      if (count == 70'000) CHECK(places != sorted);
      // What lies out of order is sorted by sorting each cell of at most that many discs.
      for (int bits = 0; bits <= 30; ++bits) {
        const auto cell = [bits](CurvePlace place) { return place_code(place) >> bits; };
        for (std::size_t first = 0; first < places.size();) {
          std::size_t end = first;
          while (end < places.size() && cell(places[end]) == cell(places[first])) ++end;
          if (end - first <= unsorted)
            std::sort(places.begin() + static_cast<std::ptrdiff_t>(first),
                      places.begin() + static_cast<std::ptrdiff_t>(end));
          first = end;
        }
      }
      CHECK(places == sorted);
    }
  }

  TEST_CASE("discs at one place keep their order") {
    const std::vector<Disc> discs(10'000);
    const CurvePlaces places = sort_along_curve(discs, box_around_centres(discs));
    for (std::size_t i = 0; i < places.size(); ++i) REQUIRE(places[i] == i);
  }

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

TEST_SUITE("known answer") {
  TEST_CASE("the curve starts at the low corner, and points outside belong to the nearest cell") {
    CHECK(hilbert_code({0, 0, 0}, unit_box) == 0);
    CHECK(hilbert_code({-1, -1, -1}, unit_box) == 0);
    CHECK(hilbert_code({9, 9, 9}, unit_box) == hilbert_code({1, 1, 1}, unit_box));
    CHECK(hilbert_code({5, 5, 5}, {{5, 5, 5}, {5, 5, 5}}) == 0);
  }

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
