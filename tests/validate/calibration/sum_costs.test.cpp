#include "detp/validate/calibration/sum_costs.hpp"

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
