#include "detp/sim/lists/cell_walk.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "detp/sim/lists/plain/ray_list.hpp"
#include "detp/sim/open/uniform_discs.hpp"

using namespace detp;
using namespace detp::sim;

TEST_SUITE("identity") {
  TEST_CASE("each sphere touches the one around it from inside, and contains the disc") {
    for (const Body body : {Body::cube, Body::cube_faces}) {
      auto discs = uniform_discs(body, 2, 2000, 0.01, 4);
      for (std::size_t i = 0; i < discs.size(); ++i) discs[i].radius /= 1 + static_cast<double>(i % 7);
      CellWalk walk(discs, 16);
      double touching = 0;
      double poking = -1;
      for (const std::uint32_t d : along_curve(discs)) {
        walk.enter(discs[d]);
        for (int level = 0; level <= 16; ++level) {
          const Sphere& sphere = walk.sphere(level);
          poking = std::max(poking, glm::distance(sphere.centre, discs[d].centre) + discs[d].radius - sphere.radius);
          if (level == 0) continue;
          const Sphere& around = walk.sphere(level - 1);
          touching =
              std::max(touching, std::abs(glm::distance(sphere.centre, around.centre) + sphere.radius - around.radius));
        }
      }
      CHECK(touching < 1e-14);
      CHECK(poking < 1e-14);
    }
  }

  TEST_CASE("along the curve each cell is entered once, so the walk enters as many cells as exist") {
    const auto discs = uniform_discs(Body::cube, 2, 5000, 0.01, 4);
    CellWalk walk(discs, 3);
    std::vector<int> entered(4);
    for (const std::uint32_t d : along_curve(discs))
      for (int level = walk.enter(discs[d]); level <= 3; ++level) ++entered[static_cast<std::size_t>(level)];
    CHECK(entered == std::vector<int>{0, 8, 64, 512});  // 5000 samples leave none of the 512 cells empty
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("cells of a cube of side 2: the sphere of an octant, and that of discs in one place") {
    const std::vector<Disc> corners{{{-1, -1, -1}, {0, 0, 1}, 0.5}, {{1, 1, 1}, {0, 0, 1}, 0.25}};
    CellWalk walk(corners, 1);
    CHECK(walk.enter(corners[0]) == 1);
    CHECK(walk.sphere(0).centre == glm::dvec3{0});
    CHECK(walk.sphere(0).radius == doctest::Approx(std::sqrt(3.0) + 0.5));
    CHECK(walk.sphere(1).centre == glm::dvec3{-0.5});
    CHECK(walk.sphere(1).radius == doctest::Approx(std::sqrt(0.75) + 0.5));
    CHECK(walk.enter(corners[0]) == 2);
    CHECK(walk.enter(corners[1]) == 1);
    CHECK(walk.sphere(1).centre == glm::dvec3{0.5});
    const std::vector<Disc> same(3, corners[1]);
    CellWalk still(same, 16);
    still.enter(same[0]);
    CHECK(still.sphere(16).centre == corners[1].centre);
    CHECK(still.sphere(16).radius == 0.25);
    CHECK(still.enter(same[1]) == 17);
  }
}
