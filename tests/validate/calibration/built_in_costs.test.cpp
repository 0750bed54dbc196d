#include "detp/validate/calibration/built_in_costs.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/validate/choice/choice.hpp"

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("a choice for rays with different powers has the costs of sums, one for equal powers has not") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 5000, 0.02, 3);
    auto rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, 5000);
    const CostTable costs = validate::built_in_unit_costs();
    const auto seconds = [&](const CostTable& with) {
      const sim::Problem problem = sim::make_problem(rays, discs);
      return validate::choose({.problem = &problem}, with).best().seconds();
    };
    const double equal = seconds(costs);
    const double of_sums = seconds(validate::costs_of_sums(costs));
    CHECK(of_sums > equal);
    rays[1234].power = 2;
    CHECK(seconds(costs) == of_sums);
  }

  TEST_CASE("a workload cannot be measured on rays without discs: a clear error") {
    const std::vector<sim::Ray> rays(10);
    CHECK_THROWS_AS(
        static_cast<void>(validate::choose({.rays = rays, .rigor = Rigor::estimate}, validate::built_in_unit_costs())),
        std::invalid_argument);
  }

  TEST_CASE("techniques that search ray by ray, and the plain engine, add powers anyway") {
    const CostTable costs = validate::built_in_unit_costs();
    CHECK(validate::costs_of_sums(costs)[Technique::octree] == costs[Technique::octree]);
    const CostTable plain = validate::built_in_unit_costs(Engine::plain);
    CHECK(validate::costs_of_sums(plain) == plain);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("built-in costs are nanoseconds by their symbols; what is not named is 0, but for the touching of memory") {
    const UnitCosts grid = validate::built_in_unit_costs(Engine::plain)[Technique::grid];
    CHECK(grid.index_test == 3.34e-9);
    CHECK(grid.start == doctest::Approx(872e-9));
    CHECK(grid.streamed == 0);
    for (const Engine engine : {Engine::simd, Engine::plain})
      for (const Technique technique : exact_techniques) {
        const UnitCosts costs = validate::built_in_unit_costs(engine)[technique];
        CHECK(costs.touch == doctest::Approx(0.054e-9));
        CHECK(costs.hit > 0);
      }
  }
}
