#include "detp/validate/choice/unit_costs.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"

using namespace detp;

namespace {

std::vector<validate::TimedRun> exact_runs(const UnitCosts& costs) {
  std::vector<validate::TimedRun> runs;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const auto a = sim::uniform4(1, sim::Stream::tests, i);
    const auto b = sim::uniform4(1, sim::Stream::tests, i, 1);
    validate::TimedRun run;
    run.counts = {.cull_tests = 1e6 * a[0],
                  .culls = 1e4 * b[1],
                  .listed = 1e5 * b[0],
                  .disc_tests = 1e6 * a[1],
                  .steps = 1e5 * a[2],
                  .nodes = 1e5 * a[3],
                  .placements = 1e5 * b[2],
                  .sorted = 1e5 * b[3]};
    run.technique = i % 2 == 0 ? Technique::sphere_cache : Technique::grid;
    const CostBreakdown time = price(run.counts, costs, run.technique);
    run.order = time.order;
    run.build = time.build;
    run.search = time.total() - time.order - time.build;
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the fit recovers the costs that made the times") {
    const UnitCosts costs{.cull_test = 1e-9,
                          .disc_test = 2e-9,
                          .index_test = 9e-9,
                          .step = 3e-9,
                          .node = 4e-9,
                          .listed = 5e-9,
                          .placement = 6e-9,
                          .leaf = 10e-9,
                          .sort = 7e-9,
                          .cull = 8e-9};
    const UnitCosts fit = validate::fit_unit_costs(exact_runs(costs));
    CHECK(fit.cull_test == doctest::Approx(costs.cull_test).epsilon(1e-9));
    CHECK(fit.disc_test == doctest::Approx(costs.disc_test).epsilon(1e-9));
    CHECK(fit.index_test == doctest::Approx(costs.index_test).epsilon(1e-9));
    CHECK(fit.step == doctest::Approx(costs.step).epsilon(1e-9));
    CHECK(fit.node == doctest::Approx(costs.node).epsilon(1e-9));
    CHECK(fit.listed == doctest::Approx(costs.listed).epsilon(1e-9));
    CHECK(fit.placement == doctest::Approx(costs.placement).epsilon(1e-9));
    CHECK(fit.leaf == doctest::Approx(costs.leaf).epsilon(1e-9));
    CHECK(fit.sort == doctest::Approx(costs.sort).epsilon(1e-9));
    CHECK(fit.cull == doctest::Approx(costs.cull).epsilon(1e-9));
  }

  TEST_CASE("a cost that would be negative is 0") {
    std::vector<validate::TimedRun> runs =
        exact_runs({.cull_test = 1e-9, .disc_test = 2e-9, .index_test = 2e-9, .step = 0, .node = 0});
    for (validate::TimedRun& run : runs) run.search -= 1e-10 * run.counts.steps;
    const UnitCosts fit = validate::fit_unit_costs(runs);
    CHECK(fit.step == 0);
    CHECK(fit.cull_test == doctest::Approx(1e-9).epsilon(0.02));
  }

  TEST_CASE("the built-in costs are below a microsecond and positive; that of a listed ray may be zero") {
    const UnitCosts c = validate::built_in_unit_costs();
    for (const double cost :
         {c.cull_test, c.disc_test, c.index_test, c.step, c.node, c.placement, c.leaf, c.sort, c.cull}) {
      CHECK(cost > 0);
      CHECK(cost < 1e-6);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a fit with fewer runs than costs is refused") {
    CHECK_THROWS_AS(static_cast<void>(validate::fit_unit_costs(std::vector<validate::TimedRun>(3))),
                    std::invalid_argument);
  }

  TEST_CASE("a run whose search took no time cannot be fitted") {
    std::vector<validate::TimedRun> runs = exact_runs({1e-9, 2e-9, 9e-9, 3e-9, 4e-9, 5e-9, 6e-9, 7e-9, 8e-9});
    runs[3].search = 0;
    CHECK_THROWS_AS(static_cast<void>(validate::fit_unit_costs(runs)), std::invalid_argument);
  }
}
