#include "detp/validate/calibration/timed_workloads.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <tuple>

namespace detp::validate {
namespace {

constexpr TimedWorkload workload{sim::Body::cube, 1000, 200, 0.01};

/// Number of cells of a grid over the discs' box that hold a centre, eight cells a side.
std::size_t filled_cells(const std::vector<sim::Disc>& discs) {
  sim::Box box;
  for (const sim::Disc& disc : discs) box.include(disc.centre);
  std::set<std::tuple<int, int, int>> cells;
  for (const sim::Disc& disc : discs) {
    const glm::dvec3 cell = 7.999 * (disc.centre - box.low) / (box.high - box.low);
    cells.emplace(static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z));
  }
  return cells.size();
}

double distance_to_nearest(const glm::dvec3& point, const std::vector<sim::Disc>& discs) {
  double least = sim::unbounded;
  for (const sim::Disc& disc : discs) least = std::min(least, glm::length(disc.centre - point));
  return least;
}

}  // namespace

TEST_SUITE("timed workloads") {
  TEST_CASE("the samples of every third workload lie in clusters: they fill far fewer cells") {
    for (std::size_t place = 0; place < 12; ++place) {
      CAPTURE(place);
      const std::size_t filled = filled_cells(discs_of(workload, place));
      if (place % 3 == 2)
        CHECK(filled < 250);
      else
        CHECK(filled > 400);
    }
  }

  TEST_CASE("half of the workloads have lines, a quarter pieces of lines, a quarter paths from sample to sample") {
    int lines = 0;
    int paths = 0;
    for (std::size_t place = 0; place < 16; ++place) {
      const auto discs = discs_of(workload, place);
      const auto rays = rays_of(workload, discs, place);
      CHECK(rays.size() == workload.rays);
      if (rays.front().length == sim::unbounded) ++lines;
      bool between = true;
      for (const sim::Ray& ray : rays) {
        CHECK(std::abs(glm::length(ray.direction) - 1) < 1e-12);
        between = between && ray.length < sim::unbounded && distance_to_nearest(ray.origin, discs) < 1e-3 &&
                  distance_to_nearest(ray.origin + ray.length * ray.direction, discs) < 2e-3;
      }
      if (between) ++paths;
    }
    CHECK(lines == 8);
    CHECK(paths == 4);
  }
}

}  // namespace detp::validate
