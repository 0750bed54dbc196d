#include "detp/model/sphere_cache/sample_spread.hpp"

#include <doctest/doctest.h>

#include "detp/sim/open/uniform_discs.hpp"

using namespace detp;

TEST_SUITE("reference value") {
  TEST_CASE("the mean square distance from the centre agrees with samples drawn in a cube and on its faces to 1 %") {
    for (const auto& [body, dimension] : {std::pair{sim::Body::cube, 3.0}, {sim::Body::cube_faces, 2.0}}) {
      double mean = 0;
      const auto discs = sim::uniform_discs(body, 2, 100'000, 0.1, 5);
      for (const sim::Disc& disc : discs) mean += glm::dot(disc.centre, disc.centre) / 1e5;
      const double expected = model::mean_square_distance(cube_workload(1, 1e5, 0.1, 2, dimension));
      CHECK(expected == doctest::Approx(mean).epsilon(0.01));
      CHECK(1.03 * expected != doctest::Approx(mean).epsilon(0.01));
    }
  }
}
