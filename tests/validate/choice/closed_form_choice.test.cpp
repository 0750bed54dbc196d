#include "detp/validate/choice/comparison.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/validate/calibration/built_in_costs.hpp"

using namespace detp;

namespace {

std::vector<Technique> all_but(Technique technique) {
  std::vector<Technique> others;
  for (const Technique one : all_techniques)
    if (one != technique) others.push_back(one);
  return others;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("with nothing disabled, it is the ranking of all techniques") {
    const Workload workload = cube_workload(1e5, 2e4, 0.02, 2);
    const auto allowed = validate::allowed_ranking(workload, validate::built_in_unit_costs(), {});
    const auto all = model::rank(workload, validate::built_in_unit_costs());
    REQUIRE(allowed.size() == all.size());
    for (std::size_t i = 0; i < all.size(); ++i) CHECK(allowed[i].candidate == all[i].candidate);
  }
}

TEST_SUITE("known answer") {
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
  TEST_CASE("with everything disabled the ranking is empty; a bad workload is refused") {
    const CostTable costs = validate::built_in_unit_costs();
    CHECK(validate::allowed_ranking(cube_workload(1e5, 2e4, 0.02, 2), costs, all_techniques).empty());
    CHECK_THROWS_AS(static_cast<void>(validate::allowed_ranking(cube_workload(0, 2e4, 0.02, 2), costs, {})),
                    std::invalid_argument);
  }
}
