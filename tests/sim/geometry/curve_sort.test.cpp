#include "detp/sim/geometry/curve_sort.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;
using namespace detp::sim::stream;

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
}
