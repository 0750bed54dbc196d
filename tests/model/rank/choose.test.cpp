#include "detp/model/rank/choose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/predict.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using support::typical;

namespace {

const UnitCosts costs{.cull_test = 2,
                      .disc_test = 5,
                      .index_test = 5,
                      .step = 4,
                      .node = 6,
                      .listed = 1,
                      .placement = 30,
                      .sort = 50,
                      .cull = 20};

bool same(const Prediction& a, const Prediction& b) {
  return a.candidate == b.candidate && a.counts == b.counts && a.time.total() == b.time.total();
}

double total(const Workload& w, const Candidate& candidate) {
  return price(predict(w, candidate), costs, candidate.technique).total();
}

/// The order of the draws does not depend on the compiler.
Workload random_cube(support::RandomNumbers& random) {
  const double rays = random.count(1, 1e8);
  const double samples = random.count(1, 1e7);
  const double radius = random.log_uniform(1e-3, 0.5);
  return cube_workload(rays, samples, radius, 2, random.uniform(2, 3));
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("techniques that cannot win are not tuned, and a search for one technique always tunes") {
    const auto ranking = rank(typical, costs);
    CHECK(ranking.front().tuned);
    CHECK(std::any_of(ranking.begin(), ranking.end(), [](const Prediction& ranked) { return !ranked.tuned; }));
    for (const Prediction& ranked : ranking) CHECK(best_of(ranked.candidate.technique, typical, costs)->tuned);
  }

  TEST_CASE("a ranking is sorted, holds each exact technique once, and each entry equals assess()") {
    support::RandomNumbers random(61);
    for (int run = 0; run < 20; ++run) {
      Workload w = random_cube(random);
      if (run == 0) w = cube_workload(4.2e6, 33, 0.0087, 2, 2.7);  // one sample more than usual leaves hold
      const auto ranking = rank(w, costs);
      REQUIRE(ranking.size() == 7);
      for (std::size_t i = 0; i < ranking.size(); ++i) {
        const Prediction& ranked = ranking[i];
        CHECK(ranked.candidate.technique != Technique::sphere_cache_published);
        CHECK(same(ranked, assess(w, ranked.candidate, costs)));
        const auto alone = best_of(ranked.candidate.technique, w, costs);
        REQUIRE(alone.has_value());
        CAPTURE(title(ranked.candidate));
        if (ranked.tuned) CHECK(ranked.time.total() <= 1.01 * alone->time.total());
        if (i == 0) continue;
        CHECK(ranking[i - 1].time.total() <= ranked.time.total());
        for (std::size_t j = 0; j < i; ++j) CHECK(ranking[j].candidate.technique != ranked.candidate.technique);
      }
    }
  }

  TEST_CASE("an assessment is the prediction, and its price") {
    for (const Candidate& candidate : {Candidate{}, Candidate{Technique::octree, OctreeParameters{5}},
                                       Candidate{Technique::sphere_cache_published, SphereCacheParameters{0.5, 4}}}) {
      const Prediction ranked = assess(typical, candidate, costs);
      CHECK(ranked.candidate == candidate);
      CHECK(ranked.counts == predict(typical, candidate));
      CHECK(ranked.time.total() == total(typical, candidate));
    }
  }

  TEST_CASE("no depth is faster than the chosen octree, and no grid of up to 400 cells a side than the chosen one") {
    for (const Workload& w : {typical, cube_workload(1e4, 1e6, 0.002, 2, 2), cube_workload(1e7, 100, 0.3, 2)}) {
      const double octree = best_of(Technique::octree, w, costs)->time.total();
      for (int depth = 0; depth <= 14; ++depth) {
        const Candidate candidate{Technique::octree, OctreeParameters{depth}};
        if (predict(w, candidate).references <= 1e9) CHECK(octree <= total(w, candidate));
      }
      const double grid = best_of(Technique::grid, w, costs)->time.total();
      for (int cells = 1; cells <= 400; ++cells) CHECK(grid <= total(w, {Technique::grid, GridParameters{cells}}));
    }
  }

  TEST_CASE("no depth is faster than that of the cell spheres chosen, no sphere tree searched than the best") {
    for (const Workload& w : {typical, cube_workload(1e4, 1e6, 0.002, 2, 2), cube_workload(1e7, 100, 0.3, 2)}) {
      const double cells = best_of(Technique::cell_spheres, w, costs)->time.total();
      for (int depth = 0; depth <= 14; ++depth)
        CHECK(cells <= total(w, {Technique::cell_spheres, CellSpheresParameters{depth}}));
      const double tree = best_of(Technique::sphere_tree, w, costs)->time.total();
      for (const int fan_out : {2, 3, 4, 6, 8, 12, 16})
        for (const int leaf : {1, 4, 12, 64, 1024}) {
          const double time = total(w, {Technique::sphere_tree, SphereTreeParameters{fan_out, leaf}});
          CHECK(tree <= time);
          for (const FixedParameters& fixed :
               {FixedParameters{{{"fan-out", std::int64_t{fan_out}}}}, FixedParameters{{{"leaf", std::int64_t{leaf}}}}})
            CHECK(total(w, *complete(Technique::sphere_tree, fixed, w, costs)) <= time);
        }
    }
    CHECK(complete(Technique::sphere_tree, {{{"fan-out", std::int64_t{5}}, {"leaf", std::int64_t{7}}}}, typical,
                   costs) == Candidate{Technique::sphere_tree, SphereTreeParameters{5, 7}});
  }

  TEST_CASE("after a stop request the ranking has what was tried until then: at least one, at most all") {
    std::stop_source source;
    source.request_stop();
    const auto some = rank(typical, costs, {.stop = source.get_token()});
    CHECK(some.size() == 1);
    CHECK(rank(typical, costs).size() > 4);
  }

  TEST_CASE("the sphere cache chosen has the best ratio and number of spheres") {
    const auto best = best_of(Technique::sphere_cache, typical, costs);
    const BestRatio expected = best_ratio_and_stop(typical, costs);
    REQUIRE(best.has_value());
    CHECK(std::get<SphereCacheParameters>(best->candidate.parameters) ==
          SphereCacheParameters{expected.ratio, expected.spheres, SampleOrder::lebesgue});
    CHECK(best->time.total() == Approx(expected.time).epsilon(1e-12));
  }

  TEST_CASE("the ranking does not depend on the unit of length") {
    const auto ranking = rank(typical, costs);
    for (const double factor : {1e-9, 1e9}) {
      const auto scaled = rank(cube_workload(1e6, 1e5, 0.01 * factor, 2 * factor), costs);
      REQUIRE(scaled.size() == ranking.size());
      for (std::size_t i = 0; i < ranking.size(); ++i) {
        CHECK(scaled[i].candidate.technique == ranking[i].candidate.technique);
        CHECK(scaled[i].time.total() == Approx(ranking[i].time.total()).epsilon(1e-9));
      }
    }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("if T is the same at every ratio, the search for the best terminates") {
    Workload w = cube_workload(1e6, 1e18, 1e-15, 1e30, 2);
    CHECK(std::isfinite(best_ratio_and_stop(w, {}).time));
    w.box = {1e40, 1e40, 1e40};  // each sample far from all others and from S0
    CHECK(std::isfinite(best_ratio_and_stop(w, {}).time));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("brute force is best for one ray and one sample, and not for a million of each") {
    CHECK(rank(cube_workload(1, 1, 0.01, 2), costs).front().candidate.technique == Technique::brute_force);
    const auto many = rank(cube_workload(1e6, 1e6, 0.01, 2), costs);
    CHECK(many.back().candidate.technique == Technique::brute_force);
    CHECK(many.back().counts.disc_tests == 1e12);
  }

  TEST_CASE("the limits of the search are respected") {
    const SearchLimits limits{.most_depth = 3, .most_cells = 1000, .most_references = 2e5};
    CHECK(std::get<OctreeParameters>(best_of(Technique::octree, typical, costs, limits)->candidate.parameters).depth <=
          3);
    const auto grid = best_of(Technique::grid, typical, costs, limits);
    CHECK(std::get<GridParameters>(grid->candidate.parameters).cells <= 10);
    CHECK(grid->counts.references <= 2e5);
    const SearchLimits none{.most_references = 10};
    CHECK_FALSE(best_of(Technique::octree, typical, costs, none).has_value());
    CHECK_FALSE(best_of(Technique::grid, typical, costs, none).has_value());
    CHECK(rank(typical, costs, none).size() == 5);
  }

  TEST_CASE("discs as large as S0, or nearly, exclude the sphere cache; the others stay in the ranking") {
    for (const double disc : {0.99, 1.0, 3.0}) {
      const Workload w{.rays = 100, .samples = 100, .disc_radius = disc, .sphere_radius = 1, .box = {1, 1, 1}};
      CHECK_FALSE(best_of(Technique::sphere_cache, w, costs).has_value());
      CHECK(rank(w, costs).size() == 6);
    }
  }

  TEST_CASE("costs decide: if steps are expensive a technique with spheres wins, if spheres are, an index") {
    UnitCosts dear_steps = costs;
    dear_steps.step = dear_steps.node = 1e6;
    const Technique without_steps = rank(typical, dear_steps).front().candidate.technique;
    CHECK((without_steps == Technique::sphere_cache || without_steps == Technique::cell_spheres ||
           without_steps == Technique::sphere_tree || without_steps == Technique::box_tree));
    UnitCosts dear_spheres = costs;
    dear_spheres.cull_test = 1e6;
    const Technique best = rank(typical, dear_spheres).front().candidate.technique;
    CHECK((best == Technique::grid || best == Technique::octree));
  }

  TEST_CASE("costs of the plain engine rank the counts of the plain engine") {
    CostTable plain(costs);
    plain.engine = Engine::plain;
    Workload many = typical;
    many.rays = 1e7;  // many blocks of the simd engine
    for (const Prediction& ranked : rank(many, plain))
      CHECK(ranked.counts == predict(many, ranked.candidate, Engine::plain));
    const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 32}};
    CHECK(assess(many, tree, plain).counts.culls < assess(many, tree, costs).counts.culls);
  }

  TEST_CASE("the number of threads is ranked, too: the times are those of the fastest number up to the most") {
    CostTable divided(costs);
    divided.threads.fill({.serial_preparing = 1, .serial_search = 0, .start = 10});
    for (const Prediction& ranked : rank(typical, divided, {.threads = 4})) {
      CAPTURE(name(ranked.candidate.technique));
      const Prediction one = assess(typical, ranked.candidate, divided);
      CHECK(one.threads == 1);
      CHECK(ranked.threads == (ranked.candidate.technique == Technique::sphere_tree ? 1 : 4));
      CHECK((ranked.time.total() < one.time.total()) == (ranked.threads == 4));
      CHECK(ranked.counts == one.counts);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no threads are refused") {
    CHECK_THROWS_AS(static_cast<void>(rank(typical, costs, {.threads = 0})), std::invalid_argument);
  }

  TEST_CASE("a workload out of range is refused by name") {
    for (const double bad : support::not_a_count) {
      Workload w = typical;
      w.rays = bad;
      const Contains name("number of rays");
      CHECK_THROWS_WITH_AS((void)rank(w, costs), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)assess(w, {}, costs), name, std::invalid_argument);
      for (const Technique technique : all_techniques)
        CHECK_THROWS_WITH_AS((void)best_of(technique, w, costs), name, std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS((void)assess(typical, {Technique::grid, OctreeParameters{}}, costs), Contains("grid"),
                         std::invalid_argument);
  }
}
