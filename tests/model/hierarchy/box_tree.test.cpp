#include "detp/model/hierarchy/box_tree.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;

namespace {

constexpr BoxTreeParameters tree{4, 16};

Counts<double> counts_of(const Workload& workload, const BoxTreeParameters& parameters = tree) {
  return box_tree_counts(workload, parameters, Engine::plain);
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("predict and rank include the box tree") {
    const Workload w = cube_workload(1e6, 1e5, 0.01, 2);
    const Candidate candidate{Technique::box_tree, tree};
    Counts<double> expected = counts_of(w);
    expected.loaded = w.rays;
    CHECK(predict(w, candidate, Engine::plain) == with_bytes_touched(expected, candidate, Engine::plain));
    CHECK(best_of(Technique::box_tree, w, {})->candidate.technique == Technique::box_tree);
  }

  TEST_CASE("all fan-outs over one binary tree, in any order, have the counts of trees of their own") {
    for (const double dimension : {1.5, 2.0, 2.4, 3.0})
      for (const int leaf : {1, 16, 300, 5000}) {
        Workload w = cube_workload(3e4, 4e3, 0.02, 2, dimension);
        w.path_length = leaf == 16 ? 0.7 : 0;
        const Valid<Workload> workload(w);
        BoxTreeShapes shapes(workload, leaf, Engine::simd);
        for (const int fan_out : {8, 2, 64, 8})
          CHECK(shapes.counts(fan_out) == box_tree_counts(workload, {fan_out, leaf}, Engine::simd));
      }
  }

  TEST_CASE("the simd engine lists rays that miss the box: some percent more, at most 2 ln(4/3)/π = 18 %") {
    for (const double dimension : {2.0, 3.0}) {
      const Workload w = cube_workload(1e4, 1e5, 0.001, 2, dimension);
      const Counts<double> plain = predict(w, {Technique::box_tree, tree}, Engine::plain);
      const Counts<double> simd = predict(w, {Technique::box_tree, tree}, Engine::simd);
      for (const auto term : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests}) {
        CHECK(simd.*term > 1.05 * plain.*term);
        CHECK(simd.*term < 1.19 * plain.*term);
      }
      CHECK(simd.hits == plain.hits);
    }
  }

  TEST_CASE("the best tree has larger leaves for few rays per disc than for many") {
    UnitCosts costs;
    costs.placement = 1e-7;
    costs.cull_test = costs.disc_test = 1e-9;
    costs.cull = 2e-7;
    costs.visit = 1e-8;
    const auto best = [&](double rays) {
      return std::get<BoxTreeParameters>(
          best_of(Technique::box_tree, cube_workload(rays, 1e5, 0.01, 2), costs)->candidate.parameters);
    };
    CHECK(best(1e3).leaf > best(1e7).leaf);
  }

  TEST_CASE("larger leaves: fewer boxes are tested, and more discs; the counts change gradually with the leaf size") {
    for (const double dimension : {2.0, 2.5, 3.0})
      for (const double disc : {1e-4, 0.01, 0.1})
        for (const double samples : {500.0, 1e4, 1e6}) {
          const Workload w = cube_workload(1e6, samples, disc, 2, dimension);
          INFO("dimension ", dimension, ", disc ", disc, ", samples ", samples);
          Counts<double> smaller = counts_of(w, {5, 2});
          for (const int leaf : {3, 4, 5, 6, 7, 9, 12, 16, 17, 40, 63, 64, 65, 100, 128, 256}) {
            const Counts<double> counts = counts_of(w, {5, leaf});
            CAPTURE(leaf);
            CHECK(counts.cull_tests < 1.01 * smaller.cull_tests);
            CHECK(counts.disc_tests > 0.99 * smaller.disc_tests);
            smaller = counts;
          }
          for (const int leaf : {16, 63, 64, 100}) {  // a leaf of one disc more
            const Counts<double> one = counts_of(w, {5, leaf});
            const Counts<double> next = counts_of(w, {5, leaf + 1});
            for (const auto term : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests})
              CHECK(next.*term == Approx(one.*term).epsilon(0.1));
          }
        }
  }

  TEST_CASE("more children: fewer rays are listed, by as much as for the next fan-out; the leaves stay the same") {
    for (const double dimension : {2.0, 2.5, 3.0})
      for (const int leaf : {1, 6, 30, 150}) {
        const Workload w = cube_workload(1e6, 3e4, 0.01, 2, dimension);
        Counts<double> fewer = counts_of(w, {2, leaf});
        for (int fan_out = 3; fan_out <= 16; ++fan_out) {
          const Counts<double> counts = counts_of(w, {fan_out, leaf});
          INFO("dimension ", dimension, ", fan_out ", fan_out);
          CHECK(counts.listed < 1.03 * fewer.listed);
          CHECK(counts.listed > 0.6 * fewer.listed);
          CHECK(counts.cull_tests == Approx(fewer.cull_tests).epsilon(0.25));
          CHECK(counts.disc_tests == Approx(fewer.disc_tests).epsilon(1e-12));
          fewer = counts;
        }
      }
  }

  TEST_CASE("twice the rays need twice the tests; the unit of length does not matter") {
    for (const double dimension : {2.0, 2.4, 3.0}) {
      const Counts<double> once = counts_of(cube_workload(1e5, 1e5, 0.01, 2, dimension));
      const Counts<double> twice = counts_of(cube_workload(2e5, 1e5, 0.01, 2, dimension));
      const Counts<double> scaled = counts_of(cube_workload(1e5, 1e5, 0.01 * 0x1p20, 0x1p21, dimension));
      for (const auto term : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests}) {
        CHECK(twice.*term == Approx(2 * once.*term).epsilon(1e-12));
        CHECK(scaled.*term == Approx(once.*term).epsilon(1e-9));
      }
    }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("a few samples make one leaf, which is tested with every ray") {
    const Counts<double> counts = counts_of(cube_workload(1000, 16, 0.01, 2));
    CHECK(counts.disc_tests == 16'000);
    CHECK(counts.cull_tests == 0);
  }

  TEST_CASE("few large leaves are tested with most rays, each disc alone: at least as often as leaves are crossed") {
    const Workload w = cube_workload(1e6, 200, 1e-4, 2);
    CHECK(counts_of(w, {4, 64}).disc_tests > 40e6);  // four leaves of 50, crossed by a quarter of the lines
  }

  TEST_CASE("many rays test each node once, and once per block with the simd engine; a single ray tests few") {
    const double nodes = counts_of(cube_workload(0x1p17, 1e4, 0.01, 2)).culls;
    CHECK(counts_of(cube_workload(0x1p27, 1e4, 0.01, 2)).culls == Approx(nodes).epsilon(1e-6));
    const Candidate candidate{Technique::box_tree, tree};
    const auto in_blocks = [&](double rays) { return predict(cube_workload(rays, 1e4, 0.01, 2), candidate); };
    REQUIRE(rays_in_block(10'000) == 1U << 16);
    CHECK(in_blocks(0x1p26).culls == Approx(1024 * in_blocks(0x1p16).culls).epsilon(1e-12));
    CHECK(in_blocks(0x1p17 + 1000).visits ==
          Approx(2 * in_blocks(0x1p16).visits + in_blocks(1000).visits).epsilon(1e-12));
    const Counts<double> one = counts_of(cube_workload(1, 1e4, 0.01, 2));
    CHECK(one.culls <= one.cull_tests * (1 + 1e-12));
    CHECK(one.culls < 0.2 * nodes);
  }

  TEST_CASE("for discs that are points, boxes enclose the samples only, for any radius") {
    for (const double dimension : {2.0, 3.0}) {
      const Counts<double> small = counts_of(cube_workload(1000, 1e5, 1e-9, 2, dimension));
      const Counts<double> smaller = counts_of(cube_workload(1000, 1e5, 1e-10, 2, dimension));
      for (const auto term : {&Counts<double>::cull_tests, &Counts<double>::listed, &Counts<double>::disc_tests})
        CHECK(smaller.*term == Approx(small.*term).epsilon(1e-4));
    }
  }

  TEST_CASE("every ray crosses discs as large as S0: all nodes are visited, all discs tested") {
    const Counts<double> counts = counts_of(cube_workload(1000, 1000, 100, 2));
    CHECK(counts.disc_tests == Approx(1e6).epsilon(1e-3));
    CHECK(counts.cull_tests == Approx(counts.listed).epsilon(1e-3));
    CHECK(counts.culls == Approx(counts.listed / 1000).epsilon(1e-3));
  }

  TEST_CASE("fan-outs above 16 count as 16; leaves above 256 samples: as many leaves for proportionally more samples") {
    const Workload w = cube_workload(1e6, 1e5, 0.001, 2);
    CHECK(counts_of(w, {1000, 16}) == counts_of(w, {16, 16}));
    const Workload fewer = cube_workload(1e6, 25e3, 0.001, 2);
    const Counts<double> large = counts_of(w, {4, 1024});
    const Counts<double> small = counts_of(fewer, {4, 256});
    CHECK(large.cull_tests == Approx(small.cull_tests));
    CHECK(large.disc_tests == Approx(4 * small.disc_tests));
  }

  TEST_CASE("larger discs are tested more often, and no disc more than once per ray; all counts are finite") {
    support::RandomNumbers random(7);
    for (int run = 0; run < 100; ++run) {
      const double rays = random.count(1, 1e9);
      const double samples = random.count(1, 1e12);
      const double dimension = random.uniform(1, 3);
      const BoxTreeParameters any{static_cast<int>(random.count(2, 1e4)), static_cast<int>(random.count(1, 1e5))};
      double before = 0;
      for (double disc = 1e-7; disc < 1; disc *= 3) {
        const Counts<double> counts = counts_of(cube_workload(rays, samples, disc, 2, dimension), any);
        for_each_term(counts, [](std::string_view, double term) { CHECK((std::isfinite(term) && term >= 0)); });
        CHECK(counts.disc_tests <= rays * samples);
        CHECK(counts.disc_tests >= 0.9 * before);
        before = counts.disc_tests;
      }
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a workload out of range is refused") {
    CHECK_THROWS_WITH_AS((void)counts_of({}, tree), Contains("rays"), std::invalid_argument);
  }
}
