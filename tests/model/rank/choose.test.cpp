#include "detp/model/rank/choose.hpp"

#include <doctest/doctest.h>
#include <tbb/parallel_for.h>

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

bool same(const Ranked& a, const Ranked& b) {
  return a.candidate == b.candidate && a.counts == b.counts && a.time.total() == b.time.total();
}

double total(const Workload& w, const Candidate& candidate) {
  return price(predict(w, candidate), costs, candidate.technique).total();
}

/// Checks for random workloads and costs, from their whole ranges, that rank returns, that all results are finite, and
/// that the work is bounded.
void check_rank(int runs, std::uint64_t seed) {
  support::RandomNumbers random(seed);
  const auto now_and_then = [&](double share) { return random.uniform(0, 1) < share; };
  for (int run = 0; run < runs; ++run) {
    Workload w{.rays = random.count(1, 1e18),
               .samples = random.count(1, 1e18),
               .sphere_radius = random.log_uniform(1e-90, 1e90),
               .dimension = random.uniform(1, 3)};
    const double side = now_and_then(0.5) ? w.sphere_radius : random.log_uniform(1e-90, 1e90);
    w.box = {side, side * random.uniform(0, 1), side * random.log_uniform(1e-12, 1)};
    w.disc_radius =
        now_and_then(0.8) ? w.sphere_radius * random.log_uniform(1e-12, 3) : random.log_uniform(1e-300, 1e300);
    if (now_and_then(0.5)) w = cube_workload(w.rays, w.samples, w.disc_radius, side, now_and_then(0.5) ? 2 : 3);
    if (now_and_then(0.2)) w.sample_extent = random.log_uniform(1e-270, 1e270);
    if (now_and_then(0.2)) w.path_length = random.log_uniform(1e-300, 1e300);
    if (w.sphere_radius < 1e-90 || w.sphere_radius > 1e90) continue;
    const auto cost = [&] { return now_and_then(0.2) ? 0 : now_and_then(0.1) ? 1e200 : random.log_uniform(1e-12, 1); };
    const UnitCosts some{cost(), cost(), cost(), cost(), cost(), cost(), cost(), cost(), cost()};
    CAPTURE(run);
    for (const Ranked& ranked : rank(w, some)) {
      CAPTURE(name(ranked.candidate.technique));
      for_each_term(ranked.counts, [](std::string_view, double term) { REQUIRE((term >= 0 && term < 1e100)); });
      REQUIRE(ranked.time.total() >= 0);
      REQUIRE(std::isfinite(ranked.time.total()));
    }
    if (run % 8 == 0) REQUIRE(best_ratio_and_stop(w, some).evaluated_spheres <= most_evaluated_spheres);
  }
}

/// A workload as one measures it: rays and samples 10² … 10⁷, d 2.5e-4 … 0.08 of the side, lines or segments, samples
/// that fill their box, its faces, or less.
Workload random_scene(support::RandomNumbers& random) {
  const auto now_and_then = [&](double share) { return random.uniform(0, 1) < share; };
  Workload w = cube_workload(random.count(1e2, 1e7), random.count(1e2, 1e7), 2 * random.log_uniform(5e-4, 0.16), 2,
                             now_and_then(0.3)   ? 2
                             : now_and_then(0.4) ? 3
                                                 : random.uniform(2, 3));
  if (now_and_then(0.5)) w.box = {2, 2 * random.uniform(0.3, 1), 2 * random.uniform(0.3, 1)};
  w.sphere_radius *= random.uniform(0.8, 1);
  if (now_and_then(0.5)) w.path_length = 2 * random.uniform(0.1, 0.7);
  if (now_and_then(0.5)) w.sample_extent = sample_extent(w) * random.uniform(0.3, 1);
  return w;
}

/// Costs in nanoseconds, about as `detp calibrate` finds them, each changed by a factor of up to 3.
CostTable random_cost_table(support::RandomNumbers& random) {
  CostTable table(UnitCosts{.cull_test = 0.6,
                            .disc_test = 0.45,
                            .listed = 1.3,
                            .leaf = 44,
                            .make = 58,
                            .sort = 68,
                            .cull = 100,
                            .visit = 100,
                            .ray = 5});
  for (const Technique technique : {Technique::octree, Technique::grid})
    table[technique] = {.index_test = 3, .step = 35, .node = 75, .placement = 95, .hit = 100};
  table[Technique::sphere_tree] = {.cull_test = 7, .disc_test = 4, .listed = 5, .make = 160, .sort = 120, .hit = 74};
  table[Technique::box_tree].cull = 37;
  table[Technique::box_tree].visit = 15;
  for (UnitCosts& some : table.of_technique)
    for (const UnitCostTerm& term : unit_cost_terms) some.*term.cost *= random.log_uniform(1 / 3.0, 3);
  return table;
}

/// The smallest time of all techniques and parameters that an exhaustive search finds.
double exhaustive(const Workload& w, const CostTable& table) {
  double least = HUGE_VAL;
  for (const Technique technique : all_techniques)
    if (record_of(technique).exact)
      if (const auto best = best_of(technique, w, table)) least = std::min(least, best->time.total());
  for (int leaf = 4; leaf <= 256; leaf *= 2)
    for (const int fan_out : {4, 8, 16})
      least = std::min(least, assess(w, {Technique::box_tree, BoxTreeParameters{fan_out, leaf}}, table).time.total());
  return least;
}

/// Checks that the ranking's best is within 1 % of the exhaustive search, and that no technique that was not tuned
/// could win.
void check_against_exhaustive(int runs, std::uint64_t seed) {
  support::RandomNumbers random(seed);
  for (int run = 0; run < runs; ++run) {
    const Workload w = random_scene(random);
    const CostTable table = random_cost_table(random);
    const auto ranking = rank(w, table);
    const double fastest = ranking.front().time.total();
    CAPTURE(seed);
    CAPTURE(run);
    CAPTURE(title(ranking.front().candidate));
    CAPTURE(w.rays);
    CAPTURE(w.samples);
    CHECK(fastest <= 1.01 * exhaustive(w, table));
    for (const Ranked& ranked : ranking)
      if (!ranked.tuned) CHECK(best_of(ranked.candidate.technique, w, table)->time.total() >= fastest / 1.01);
  }
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the ranking's best takes at most 1 % longer than that of an exhaustive search") {
    check_against_exhaustive(15, 11);
  }

  TEST_CASE("techniques that cannot win are not tuned, and a search for one technique always tunes") {
    const auto ranking = rank(typical, costs);
    CHECK(ranking.front().tuned);
    CHECK(std::any_of(ranking.begin(), ranking.end(), [](const Ranked& ranked) { return !ranked.tuned; }));
    for (const Ranked& ranked : ranking) CHECK(best_of(ranked.candidate.technique, typical, costs)->tuned);
  }

  TEST_CASE("a ranking is sorted, holds each exact technique once, and each entry equals assess()") {
    support::RandomNumbers random(61);
    for (int run = 0; run < 20; ++run) {
      const Workload w = cube_workload(random.count(1, 1e8), random.count(1, 1e7), random.log_uniform(1e-3, 0.5), 2,
                                       random.uniform(2, 3));
      const auto ranking = rank(w, costs);
      REQUIRE(ranking.size() == 7);
      for (std::size_t i = 0; i < ranking.size(); ++i) {
        const Ranked& ranked = ranking[i];
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
      const Ranked ranked = assess(typical, candidate, costs);
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
  TEST_CASE("workloads and costs from their whole ranges: rank returns, all results are finite, the work is bounded") {
    check_rank(250, 71);
  }

  TEST_CASE("if T is the same at every ratio, the search for the best terminates") {
    Workload w = cube_workload(1e6, 1e18, 1e-15, 1e30, 2);
    CHECK(best_ratio_and_stop(w, {}).evaluated_spheres <= most_evaluated_spheres);
    w.box = {1e40, 1e40, 1e40};  // each sample far from all others and from S0
    CHECK(best_ratio_and_stop(w, {}).evaluated_spheres <= most_evaluated_spheres);
    CHECK(best_ratio_and_stop(typical, costs).evaluated_spheres < most_evaluated_spheres / 2);
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
}

TEST_SUITE("known answer") {
  TEST_CASE("costs of the plain engine rank the counts of the plain engine") {
    CostTable plain(costs);
    plain.engine = Engine::plain;
    Workload many = typical;
    many.rays = 1e7;  // many blocks of the simd engine
    for (const Ranked& ranked : rank(many, plain))
      CHECK(ranked.counts == predict(many, ranked.candidate, Engine::plain));
    const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 32}};
    CHECK(assess(many, tree, plain).counts.culls < assess(many, tree, costs).counts.culls);
  }

  TEST_CASE("the number of threads is ranked, too: the times are those of the fastest number up to the most") {
    CostTable divided(costs);
    divided.threads.fill({.serial_preparing = 1, .serial_search = 0, .start = 10});
    for (const Ranked& ranked : rank(typical, divided, {.threads = 4})) {
      CAPTURE(name(ranked.candidate.technique));
      const Ranked one = assess(typical, ranked.candidate, divided);
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

TEST_SUITE("hard-cases") {
  TEST_CASE("four hundred workloads and costs: the ranking's best takes at most 1 % longer than an exhaustive one's") {
    tbb::parallel_for(0, 10, [](int part) { check_against_exhaustive(40, 172 + static_cast<std::uint64_t>(part)); });
  }

  TEST_CASE("five thousand workloads and costs: rank returns, all results are finite, and the work is bounded") {
    tbb::parallel_for(0, 10, [](int part) { check_rank(500, 72 + static_cast<std::uint64_t>(part)); });
  }
}
