#include "detp/sim/rays/ray_source.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <vector>

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
