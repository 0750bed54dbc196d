#include "detp/model/box_tree.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/choose.hpp"
#include "detp/model/line_measure.hpp"
#include "detp/model/predict.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

constexpr BoxTreeParameters tree{4, 16};

Counts<double> counts_of(const Workload& workload) { return box_tree_counts(workload, tree); }

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("predict and rank know the tree of boxes") {
    const Workload w = cube_workload(1e6, 1e5, 0.01, 2);
    const Candidate candidate{Technique::box_tree, tree};
    CHECK(predict(w, candidate, Engine::plain) == counts_of(w));
    CHECK(best_of(Technique::box_tree, w, {})->candidate == candidate);
  }

  TEST_CASE("each tree that the rule gives is tabulated: few rays a disc want large leaves, many small ones") {
    for (const auto& [rays, leaf] : {std::pair{5e4, 64}, {1e5, 16}, {6.3e6, 16}, {6.4e6, 8}}) {
      const Workload w = cube_workload(rays, 1e5, 0.01, 2);
      const BoxTreeParameters best{4, leaf};
      CHECK(is_tabulated(best));
      CHECK(best_of(Technique::box_tree, w, {})->candidate == Candidate{Technique::box_tree, best});
    }
  }

  TEST_CASE("larger leaves: fewer boxes are tested, and more discs") {
    for (const double dimension : {2.0, 2.5, 3.0})
      for (const double disc : {1e-4, 1e-3, 0.01, 0.1})
        for (const double samples : {200.0, 1e4, 1e6}) {
          const Workload w = cube_workload(1e6, samples, disc, 2, dimension);
          Counts<double> smaller = box_tree_counts(w, {4, 8});
          for (const int leaf : {16, 64}) {
            const Counts<double> counts = box_tree_counts(w, {4, leaf});
            CHECK(counts.cull_tests < 1.02 * smaller.cull_tests);
            CHECK(counts.disc_tests > 0.98 * smaller.disc_tests);
            smaller = counts;
          }
        }
  }

  TEST_CASE("twice the rays, twice the tests; the unit of length does not matter") {
    for (const double dimension : {2.0, 2.4, 3.0}) {
      const Counts<double> once = counts_of(cube_workload(1e5, 1e5, 0.01, 2, dimension));
      const Counts<double> twice = counts_of(cube_workload(2e5, 1e5, 0.01, 2, dimension));
      const Counts<double> scaled = counts_of(cube_workload(1e5, 1e5, 0.01e6, 2e6, dimension));
      for (const auto term : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests}) {
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
    CHECK(counts.cull_tests == 0);
  }

  TEST_CASE("few large leaves are tested with most rays, each disc by itself: not fewer than leaves are crossed") {
    const Workload w = cube_workload(1e6, 200, 1e-4, 2);
    CHECK(box_tree_counts(w, {4, 64}).disc_tests > 40e6);  // four leaves of 50, crossed by a quarter
  }

  TEST_CASE("many rays test each node once, and once for each block by the simd engine; a single one few") {
    const double nodes = counts_of(cube_workload(0x1p17, 1e4, 0.01, 2)).culls;
    CHECK(counts_of(cube_workload(0x1p27, 1e4, 0.01, 2)).culls == Approx(nodes).epsilon(1e-6));
    const Candidate candidate{Technique::box_tree, tree};
    const auto in_blocks = [&](double rays) { return predict(cube_workload(rays, 1e4, 0.01, 2), candidate); };
    REQUIRE(rays_in_block(10'000) == 1U << 16);
    CHECK(in_blocks(0x1p26).culls == Approx(1024 * in_blocks(0x1p16).culls).epsilon(1e-12));
    CHECK(in_blocks(0x1p17 + 1000).visits ==
          Approx(2 * in_blocks(0x1p16).visits + in_blocks(1000).visits).epsilon(1e-12));
    const Counts<double> one = counts_of(cube_workload(1, 1e4, 0.01, 2));
    CHECK(one.culls <= one.cull_tests);
    CHECK(one.culls < 0.2 * nodes);
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
    for (const BoxTreeParameters& other : {BoxTreeParameters{8, 16}, BoxTreeParameters{4, 12}})
      CHECK_THROWS_WITH_AS((void)box_tree_counts(w, other), Contains("fan-out 4 and 8, 16, 64 samples a leaf"),
                           std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)box_tree_counts({}, tree), Contains("rays"), std::invalid_argument);
  }
}
