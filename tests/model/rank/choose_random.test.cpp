#include <doctest/doctest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "detp/model/rank/choose.hpp"
#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model;

namespace {

/// Checks for random workloads and costs, from their whole ranges, that rank returns, and that all results are finite.
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
    for (const Prediction& ranked : rank(w, some)) {
      CAPTURE(name(ranked.candidate.technique));
      for_each_term(ranked.counts, [](std::string_view, double term) { REQUIRE((term >= 0 && term < 1e100)); });
      REQUIRE(ranked.time.total() >= 0);
      REQUIRE(std::isfinite(ranked.time.total()));
    }
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
                            .placement = 44,
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
    INFO("seed ", seed, ", run ", run, ", title(ranking.front().candidate) ", title(ranking.front().candidate),
         ", w.rays ", w.rays, ", w.samples ", w.samples);
    CHECK(fastest <= 1.01 * exhaustive(w, table));
    for (const Prediction& ranked : ranking)
      if (!ranked.tuned) CHECK(best_of(ranked.candidate.technique, w, table)->time.total() >= fastest / 1.01);
  }
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the ranking's best takes at most 1 % longer than that of an exhaustive search") {
    check_against_exhaustive(15, 11);
  }
}

TEST_SUITE("limit") {
  TEST_CASE("workloads and costs from their whole ranges: rank returns, all results are finite") {
    check_rank(250, 71);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("four hundred workloads and costs: the ranking's best takes at most 1 % longer than an exhaustive one's") {
    tbb::parallel_for(0, 10, [](int part) { check_against_exhaustive(40, 172 + static_cast<std::uint64_t>(part)); });
  }

  TEST_CASE("five thousand workloads and costs: rank returns, all results are finite") {
    tbb::parallel_for(0, 10, [](int part) { check_rank(500, 72 + static_cast<std::uint64_t>(part)); });
  }
}
