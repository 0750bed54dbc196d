#include "detp/validate/choice/pilot.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/choice/comparison.hpp"

using namespace detp;
using doctest::Approx;
using validate::usual_shape;

namespace {

std::vector<sim::Ray> pieces_of_lines(const std::vector<sim::Disc>& discs, std::size_t count, double length) {
  std::vector<sim::Ray> rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, count);
  for (sim::Ray& ray : rays) ray.length = length;
  return rays;
}

struct Bounded {
  Bounded(std::size_t samples, double radius, std::size_t count, double length = sim::Ray{}.length)
      : discs(sim::uniform_discs(sim::Body::cube_faces, 2, samples, radius, 3)),
        rays(pieces_of_lines(discs, count, length)),
        problem(sim::make_problem(rays, discs)) {}

  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  sim::Problem problem;
};

std::vector<Technique> all_but(Technique technique) {
  std::vector<Technique> others;
  for (const Technique one : all_techniques)
    if (one != technique) others.push_back(one);
  return others;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("no box tree visits fewer discs or tests fewer rays, if all discs and rays are tried") {
    for (const double radius : {0.01, 0.1, 0.5})
      for (const double length : {sim::Ray{}.length, 0.7}) {
        const Bounded example(64, radius, 100, length);
        const auto least = validate::least_box_tree_counts(example.problem, example.rays, 100);
        if (radius >= 0.1) CHECK(least.visits > 0);
        CHECK(least.segments == (example.rays.front().is_line() ? 0 : 100));
        for (const int leaf : {1, 4, 16, 64}) {
          const auto counts = sim::run(example.problem, {Technique::box_tree, BoxTreeParameters{8, leaf}}, {}).counts;
          CHECK(least.visits <= static_cast<double>(counts.visits) * (1 + 1e-12));
          CHECK(least.disc_tests <= static_cast<double>(counts.disc_tests) * (1 + 1e-12));
        }
      }
  }

  TEST_CASE("with nothing disabled, it is the ranking of all techniques") {
    const Workload workload = cube_workload(1e5, 2e4, 0.02, 2);
    const auto allowed = validate::allowed_ranking(workload, validate::built_in_unit_costs(), {});
    const auto all = model::rank(workload, validate::built_in_unit_costs());
    REQUIRE(allowed.size() == all.size());
    for (std::size_t i = 0; i < all.size(); ++i) CHECK(allowed[i].candidate == all[i].candidate);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("where every ray crosses the sphere around every disc, each disc is tested with every ray, once") {
    Bounded example(10'000, 2, 300);
    for (sim::Ray& ray : example.rays) ray.origin = {};  // the centre of the cube
    const auto least = validate::least_box_tree_counts(example.problem, example.rays, 300);
    CHECK(least.visits == Approx(10'000));
    CHECK(least.disc_tests == Approx(3e6));
  }

  TEST_CASE("few rays and large discs: brute force is chosen before sorting, from the sample alone, too") {
    const CostTable costs = validate::built_in_unit_costs();
    bool decided_by_search = false;
    for (const std::size_t rays : {20UL, 40UL, 60UL, 80UL, 100UL, 120UL, 150UL}) {
      const Bounded large(20'000, 2, rays);
      const double seconds =
          price({.loaded = static_cast<double>(rays), .visits = 2e4, .disc_tests = 2e4 * static_cast<double>(rays)},
                costs, Technique::brute_force)
              .total();
      const double preparing = price({.placements = 2e4, .sorted = 2e4}, costs, Technique::box_tree).total();
      const sim::Problem without_rays = sim::searched_problem(large.discs, {}, false, {});
      const auto found = validate::choose({.problem = &large.problem}, costs);
      const auto by_sample = validate::choose(
          {.problem = &without_rays, .rays = large.rays, .ray_count = static_cast<double>(rays)}, costs);
      CAPTURE(rays);
      CHECK(found.best().candidate == by_sample.best().candidate);
      if (seconds > 1.4 * preparing) continue;
      CHECK(found.best().candidate.technique == Technique::brute_force);
      CHECK(found.discs == nullptr);
      decided_by_search = decided_by_search || seconds > preparing;
    }
    CHECK(decided_by_search);
    const Bounded small(20'000, 0.001, 100);
    CHECK(validate::choose({.problem = &small.problem}, costs).best().candidate.technique == Technique::box_tree);
  }

  TEST_CASE("leaves are 24 (discs/rays)^0.3, a power of two from 8 to 512") {
    CHECK(usual_shape(1000, 1000) == BoxTreeParameters{4, 32});
    CHECK(usual_shape(1000, 16'000) == BoxTreeParameters{4, 64});
    CHECK(usual_shape(4000, 1000) == BoxTreeParameters{4, 16});
    CHECK(usual_shape(1, 1e18) == BoxTreeParameters{4, 512});
    CHECK(usual_shape(1e18, 1) == BoxTreeParameters{4, 8});
  }

  TEST_CASE("leaves are smaller where tests are slower than placing, within limits") {
    CHECK(usual_shape(1000, 1000, 8) == BoxTreeParameters{4, 8});
    CHECK(usual_shape(1000, 16'000, 32) == BoxTreeParameters{4, 32});
    CHECK(usual_shape(1000, 16'000, 1024) == BoxTreeParameters{4, 128});
    CHECK(usual_shape(1000, 16'000, std::numeric_limits<double>::infinity()) == BoxTreeParameters{4, 128});
    CHECK(usual_shape(1000, 16'000, 0) == usual_shape(1000, 16'000, 1));
  }

  TEST_CASE("a technique alone has its best parameters, although others would be faster") {
    const Workload workload = cube_workload(1e5, 2e4, 0.02, 2);
    const CostTable costs = validate::built_in_unit_costs();
    bool was_untuned = false;
    for (const Prediction& one : model::rank(workload, costs)) {
      CAPTURE(one.candidate.technique);
      was_untuned = was_untuned || !one.tuned;
      const auto others = all_but(one.candidate.technique);
      const auto alone = validate::allowed_ranking(workload, costs, others);
      REQUIRE(alone.size() == 1);
      CHECK(alone.front().tuned);
      const auto best = model::best_of(one.candidate.technique, workload, costs);
      CHECK(alone.front().time.total() <= 1.01 * best.value().time.total());
    }
    CHECK(was_untuned);
  }

  TEST_CASE("a sphere cache with extrapolated counts never comes first while a box tree is allowed") {
    const auto first = [](double dimension, double seconds_over_others) {
      Workload workload = cube_workload(1e5, 2e4, 0.02, 2);
      workload.dimension = dimension;
      CostTable costs = validate::built_in_unit_costs();
      const auto ranking = model::rank(workload, costs);
      const double sphere_cache = model::best_of(Technique::sphere_cache, workload, costs)->time.total();
      REQUIRE(ranking.front().candidate.technique == Technique::box_tree);
      UnitCosts& scaled = costs[Technique::sphere_cache];
      for (const UnitCostTerm& term : unit_cost_terms)
        scaled.*term.cost *= seconds_over_others * ranking.front().time.total() / sphere_cache;
      return validate::allowed_ranking(workload, costs, {}).front().candidate.technique;
    };
    CHECK(first(2, 0.7) == Technique::sphere_cache);
    CHECK(first(2, 1.2) == Technique::box_tree);
    CHECK(first(2.3, 0.7) == Technique::box_tree);  // between the dimensions with which closed forms were compared
    CHECK(first(2.3, 0.1) == Technique::box_tree);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers that are no numbers of rays and discs are refused") {
    CHECK_THROWS_AS(static_cast<void>(usual_shape(0, 10)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(usual_shape(10, 0.5)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(usual_shape(10, 10, std::nan(""))), std::invalid_argument);
  }

  TEST_CASE("with everything disabled the ranking is empty; a bad workload is refused") {
    const CostTable costs = validate::built_in_unit_costs();
    CHECK(validate::allowed_ranking(cube_workload(1e5, 2e4, 0.02, 2), costs, all_techniques).empty());
    CHECK_THROWS_AS(static_cast<void>(validate::allowed_ranking(cube_workload(0, 2e4, 0.02, 2), costs, {})),
                    std::invalid_argument);
  }
}
