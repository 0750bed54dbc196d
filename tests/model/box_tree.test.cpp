#include "detp/model/box_tree.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "detp/model/choose.hpp"
#include "detp/model/line_measure.hpp"
#include "detp/model/predict.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

Counts<double> counts_of(const Workload& workload) { return box_tree_counts(workload, tabulated_box_tree); }

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("predict and rank know the tree of boxes") {
    const Workload w = cube_workload(1e6, 1e5, 0.01, 2);
    const Candidate candidate{Technique::sphere_tree, tabulated_box_tree};
    CHECK(predict(w, candidate) == counts_of(w));
    CHECK(best_of(Technique::sphere_tree, w, {})->candidate == candidate);
  }

  TEST_CASE("twice the rays, twice the tests; the unit of length does not matter") {
    for (const double dimension : {2.0, 2.4, 3.0}) {
      const Counts<double> once = counts_of(cube_workload(1e5, 1e5, 0.01, 2, dimension));
      const Counts<double> twice = counts_of(cube_workload(2e5, 1e5, 0.01, 2, dimension));
      const Counts<double> scaled = counts_of(cube_workload(1e5, 1e5, 0.01e6, 2e6, dimension));
      for (const auto term : {&Counts<double>::sphere_tests, &Counts<double>::copies, &Counts<double>::disc_tests}) {
        CHECK(twice.*term == Approx(2 * once.*term).epsilon(1e-12));
        CHECK(scaled.*term == Approx(once.*term).epsilon(1e-9));
      }
    }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("few samples are one leaf, tested with every ray") {
    const Counts<double> counts = counts_of(cube_workload(1000, 16, 0.01, 2));
    CHECK(counts.disc_tests == 16'000);
    CHECK(counts.sphere_tests == 0);
  }

  TEST_CASE("many rays test each node once a block; a single one few") {
    const double nodes = counts_of(cube_workload(0x1p17, 1e4, 0.01, 2)).rebuilds;
    CHECK(counts_of(cube_workload(0x1p27, 1e4, 0.01, 2)).rebuilds == Approx(1024 * nodes).epsilon(1e-6));
    const Counts<double> one = counts_of(cube_workload(1, 1e4, 0.01, 2));
    CHECK(one.rebuilds <= one.sphere_tests);
    CHECK(one.rebuilds < 0.2 * nodes);
  }

  TEST_CASE("larger discs are tested more often, and no disc more than once a ray; all is finite") {
    support::RandomNumbers random(7);
    for (int run = 0; run < 200; ++run) {
      const double rays = random.count(1, 1e9);
      const double samples = random.count(1, 1e12);
      const double dimension = random.uniform(1, 3);
      double before = 0;
      for (double disc = 1e-7; disc < 1; disc *= 3) {
        const Counts<double> counts = counts_of(cube_workload(rays, samples, disc, 2, dimension));
        for_each_term(counts, [](std::string_view, double term) { CHECK((std::isfinite(term) && term >= 0)); });
        CHECK(counts.disc_tests <= rays * samples);
        CHECK(counts.disc_tests >= 0.9 * before);
        before = counts.disc_tests;
      }
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("other trees are refused, telling which one is known") {
    const Workload w = cube_workload(1000, 1000, 0.01, 2);
    for (const SphereTreeParameters& other : {SphereTreeParameters{8, 16, Bounds::boxes},
                                              SphereTreeParameters{4, 8, Bounds::boxes}, SphereTreeParameters{4, 16}})
      CHECK_THROWS_WITH_AS((void)box_tree_counts(w, other), Contains("fan-out 4 and 16 samples a leaf"),
                           std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)box_tree_counts({}, tabulated_box_tree), Contains("rays"), std::invalid_argument);
  }
}
