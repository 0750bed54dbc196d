#include "detp/validate/calibration/cost_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/statistics/statistics.hpp"

using namespace detp;

namespace {

UnitCosts zero_costs() {
  UnitCosts costs;
  for (const UnitCostTerm& term : unit_cost_terms) costs.*term.cost = 0;
  return costs;
}

/// Runs with random counts, whose seconds are exactly those of the costs.
std::vector<validate::TimedRun> exact_runs(const UnitCosts& costs, Technique technique) {
  std::vector<validate::TimedRun> runs;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto a = sim::uniform4(1, sim::Stream::tests, i);
    const auto b = sim::uniform4(1, sim::Stream::tests, i, 1);
    const auto c = sim::uniform4(1, sim::Stream::tests, i, 2);
    validate::TimedRun run{.workload = i,
                           .counts = {.loaded = 1e5 * c[0], .disc_tests = 1e6 * a[1], .hits = 1e5 * c[1]}};
    if (technique == Technique::grid) {
      run.counts.steps = 1e5 * a[2];
      run.counts.nodes = 1e5 * a[3];
      run.counts.placements = 1e4 * b[2];
    } else {
      run.counts.cull_tests = 1e6 * a[0];
      run.counts.culls = 1e4 * b[1];
      run.counts.listed = 1e5 * b[0];
      run.counts.visits = 1e4 * c[2];
      run.counts.sorted = 1e5 * b[3];
    }
    const CostBreakdown time = price(run.counts, costs, technique);
    run.seconds = time.total();
    run.build_seconds = time.order + time.build;
    runs.push_back(run);
  }
  return runs;
}

void check_recovered(const UnitCosts& costs, Technique technique) {
  const validate::CostFit fit = validate::fit_costs(exact_runs(costs, technique), technique);
  for (const UnitCostTerm& term : unit_cost_terms) {
    CAPTURE(term.symbol);
    CHECK(fit.costs.*term.cost == doctest::Approx(costs.*term.cost).epsilon(1e-7));
  }
  CHECK(fit.median_error < 1e-9);
  CHECK(validate::median(fit.left_out_errors) < 1e-9);
  CHECK(fit.dropped.empty());
}

/// Runs of 0.1 ms to 100 ms on 2 and 4 threads, whose seconds are exactly those of the costs.
std::vector<validate::ThreadedRun> exact_threaded_runs(const ThreadCosts& costs, Technique technique) {
  std::vector<validate::ThreadedRun> runs;
  for (std::uint64_t i = 0; i < 30; ++i) {
    const auto random = sim::uniform4(1, sim::Stream::tests, i);
    validate::ThreadedRun run{
        .workload = i,
        .counts = {.loaded = 1e4 + 1e5 * random[0], .placements = 1e5 * random[1], .sorted = 1e5 * random[1]},
        .threads = i % 2 == 0 ? 2 : 4};
    run.one_seconds = 1e-4 + 0.1 * random[2] * random[2];
    run.one_preparing = random[3] * run.one_seconds;
    const CostBreakdown one{.build = run.one_preparing, .intersect = run.one_seconds - run.one_preparing};
    const CostBreakdown more = on_threads(one, pieces_of(run.counts, technique, Engine::simd), costs, run.threads);
    run.seconds = more.total();
    run.preparing = more.build;
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a cost whose count no run has keeps its usual ratio to the others") {
    UnitCosts usual = zero_costs();
    usual.cull_test = usual.disc_test = 1e-9;
    usual.sort = 5e-8;
    usual.ray = 6e-9;
    UnitCosts slower = usual;
    for (const UnitCostTerm& term : unit_cost_terms) slower.*term.cost *= 3;
    usual.touch = 7e-9;  // repeated runs touch no memory for the first time
    const auto runs = exact_runs(slower, Technique::sphere_cache);
    CHECK(validate::fit_costs(runs, Technique::sphere_cache, usual).costs.touch == doctest::Approx(21e-9));
    CHECK(validate::fit_costs(runs, Technique::sphere_cache).costs.touch == 0);
  }

  TEST_CASE("the fit recovers the costs that made the times") {
    UnitCosts lists = zero_costs();
    lists.cull_test = 1e-9;
    lists.disc_test = 2e-9;
    lists.listed = 3e-9;
    lists.cull = 2e-7;
    lists.visit = 3e-8;
    lists.sort = 5e-8;
    lists.hit = 1e-8;
    lists.ray = 6e-9;
    lists.start = 1e-5;
    check_recovered(lists, Technique::sphere_cache);
    UnitCosts one_by_one = zero_costs();
    one_by_one.index_test = 9e-9;
    one_by_one.step = 3e-8;
    one_by_one.node = 4e-8;
    one_by_one.placement = 6e-8;
    check_recovered(one_by_one, Technique::grid);
  }

  TEST_CASE("a cost that would be negative is 0") {
    UnitCosts costs = zero_costs();
    costs.index_test = 1e-8;
    costs.node = 5e-8;
    std::vector<validate::TimedRun> runs = exact_runs(costs, Technique::grid);
    for (validate::TimedRun& run : runs) run.seconds -= 1e-10 * run.counts.steps;
    const UnitCosts fit = validate::fit_costs(runs, Technique::grid).costs;
    CHECK(fit.step == 0);
    CHECK(fit.index_test == doctest::Approx(1e-8).epsilon(0.02));
  }

  TEST_CASE("of costs that the runs cannot tell apart one is dropped, and the fit says which") {
    UnitCosts costs = zero_costs();
    costs.cull_test = 1e-9;
    costs.listed = 1e-9;
    costs.disc_test = 1e-9;
    std::vector<validate::TimedRun> runs = exact_runs(costs, Technique::sphere_cache);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      runs[i].counts.listed = runs[i].counts.cull_tests * (1 + (i % 2 == 0 ? 1e-6 : -1e-6));
      runs[i].seconds = price(runs[i].counts, costs, Technique::sphere_cache).total();
    }
    const validate::CostFit fit = validate::fit_costs(runs, Technique::sphere_cache);
    CHECK(fit.condition <= validate::largest_condition);
    CHECK(fit.costs.cull_test + fit.costs.listed == doctest::Approx(2e-9).epsilon(1e-3));
    CHECK((fit.costs.cull_test == 0) != (fit.costs.listed == 0));
    CHECK(fit.median_error < 1e-5);
  }

  TEST_CASE("costs that the runs cannot tell apart keep their usual ratio") {
    UnitCosts usual = zero_costs();
    usual.cull_test = 1e-9;
    usual.listed = 2e-9;
    usual.disc_test = 1e-9;
    UnitCosts slower = usual;  // of a machine that is three times as slow, except at disc tests
    slower.cull_test *= 3;
    slower.listed *= 3;
    slower.disc_test *= 1.5;
    std::vector<validate::TimedRun> runs = exact_runs(slower, Technique::sphere_cache);
    for (validate::TimedRun& run : runs) {
      const double other = sim::uniform4(2, sim::Stream::tests, run.workload)[0] - 0.5;
      run.counts.listed = run.counts.cull_tests * (1 + 0.05 * other);
      run.counts.disc_tests /= 4;
      run.seconds = price(run.counts, slower, Technique::sphere_cache).total() * (1 + 0.1 * other);
    }
    const UnitCosts alone = validate::fit_costs(runs, Technique::sphere_cache).costs;
    CHECK(alone.cull_test == 0);  // the disturbance is taken for a cost of `listed`
    const UnitCosts fit = validate::fit_costs(runs, Technique::sphere_cache, usual).costs;
    CHECK(fit.listed / fit.cull_test == doctest::Approx(2).epsilon(0.15));
    CHECK(fit.cull_test + fit.listed == doctest::Approx(9e-9).epsilon(0.03));
    CHECK(fit.disc_test == doctest::Approx(1.5e-9).epsilon(0.1));
  }

  TEST_CASE("the error on left-out runs shows a fit that does not carry over") {
    UnitCosts costs = zero_costs();
    costs.disc_test = 1e-9;
    std::vector<validate::TimedRun> runs = exact_runs(costs, Technique::brute_force);
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i].seconds *= i % 2 == 0 ? 0.5 : 1.5;
    CHECK(validate::median(validate::fit_costs(runs, Technique::brute_force).left_out_errors) > 0.2);
  }

  TEST_CASE("the built-in costs of every exact technique give a run a time") {
    const CostTable costs = validate::built_in_unit_costs();
    CHECK_NOTHROW(check(costs));
    const Counts<double> counts{.loaded = 1000,
                                .cull_tests = 1e4,
                                .culls = 100,
                                .listed = 1e4,
                                .visits = 1000,
                                .disc_tests = 1e4,
                                .steps = 1e4,
                                .nodes = 1e4,
                                .placements = 1000,
                                .sorted = 1000,
                                .hits = 100};
    for (const Technique technique : all_techniques) {
      if (!record_of(technique).exact) continue;
      CAPTURE(name(technique));
      const double seconds = price(counts, costs, technique).total();
      CHECK(seconds > 1e-6);
      CHECK(seconds < 1e-2);
    }
  }

  TEST_CASE("the fit recovers the costs of threads that made the times") {
    const ThreadCosts costs{.serial_preparing = 0.6, .serial_search = 0.15, .start = 2e-5};
    const auto fit =
        validate::fit_threads(exact_threaded_runs(costs, Technique::box_tree), Technique::box_tree, Engine::simd);
    CHECK(fit.costs.serial_preparing == doctest::Approx(0.6).epsilon(1e-6));
    CHECK(fit.costs.serial_search == doctest::Approx(0.15).epsilon(1e-6));
    CHECK(fit.costs.start == doctest::Approx(2e-5).epsilon(1e-6));
    CHECK(fit.median_error < 1e-9);
    CHECK(validate::median(fit.left_out_errors) < 1e-9);
    CHECK(fit.left_out_errors.size() == 30);
  }

  TEST_CASE("where one thread builds, all of it counts as serial") {
    const ThreadCosts costs{.serial_preparing = 1, .serial_search = 0.3, .start = 0};
    const auto fit = validate::fit_threads(exact_threaded_runs(costs, Technique::grid), Technique::grid, Engine::simd);
    CHECK(fit.costs.serial_preparing == 1);
    CHECK(fit.costs.serial_search == doctest::Approx(0.3).epsilon(1e-6));
    CHECK(fit.costs.start < 1e-12);
  }

  TEST_CASE("runs that are slower on more threads give serial shares of 1, and starts take the rest") {
    std::vector<validate::ThreadedRun> runs = exact_threaded_runs({}, Technique::grid);
    for (validate::ThreadedRun& run : runs) run.seconds = 1.3 * run.one_seconds + 1e-4 * (run.threads - 1);
    const ThreadCosts costs = validate::fit_threads(runs, Technique::grid, Engine::simd).costs;
    CHECK(costs.serial_search == 1);
    CHECK(costs.start > 0);
    CHECK_NOTHROW(check(costs));
  }

  TEST_CASE("what the runs do not show stays as usual") {
    const ThreadCosts usual{.serial_preparing = 0.4, .serial_search = 0.2, .start = 5e-5};
    std::vector<validate::ThreadedRun> runs = exact_threaded_runs({.serial_search = 0.7}, Technique::box_tree);
    for (validate::ThreadedRun& run : runs) {
      run.one_preparing /= 1000;  // hardly any time for sorting and building, so their share does not show
      run.preparing = 0;
      run.one_seconds = 1;  // nor does the start
      run.seconds = run.threads == 2 ? 0.85 : 0.775;
    }
    const ThreadCosts alone = validate::fit_threads(runs, Technique::box_tree, Engine::simd).costs;
    const ThreadCosts costs = validate::fit_threads(runs, Technique::box_tree, Engine::simd, usual).costs;
    CHECK(costs.serial_preparing == doctest::Approx(0.4).epsilon(0.01));
    CHECK(costs.serial_search == doctest::Approx(0.7).epsilon(0.05));
    CHECK(costs.start == doctest::Approx(5e-5).epsilon(0.01));
    CHECK(std::abs(alone.serial_preparing - 0.4) > 0.1);
  }

  TEST_CASE("the error on left-out runs shows that times do not follow the law") {
    std::vector<validate::ThreadedRun> runs =
        exact_threaded_runs({.serial_preparing = 0.5, .serial_search = 0.5, .start = 0}, Technique::box_tree);
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i].seconds *= i % 4 < 2 ? 0.5 : 1.5;
    CHECK(validate::median(validate::fit_threads(runs, Technique::box_tree, Engine::simd).left_out_errors) > 0.2);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a fit of few runs is refused") {
    CHECK_THROWS_AS(
        static_cast<void>(validate::fit_costs(std::vector<validate::TimedRun>(9, {.seconds = 1}), Technique::grid)),
        std::invalid_argument);
  }

  TEST_CASE("a run that took no time cannot be fitted") {
    std::vector<validate::TimedRun> runs = exact_runs(UnitCosts{}, Technique::grid);
    runs[3].seconds = 0;
    CHECK_THROWS_AS(static_cast<void>(validate::fit_costs(runs, Technique::grid)), std::invalid_argument);
  }

  TEST_CASE("few runs, a run without time and a run on one thread are refused") {
    const auto good = exact_threaded_runs({}, Technique::grid);
    const auto refused = [&](const std::vector<validate::ThreadedRun>& runs) {
      CHECK_THROWS_AS(static_cast<void>(validate::fit_threads(runs, Technique::grid, Engine::simd)),
                      std::invalid_argument);
    };
    refused({good.begin(), good.begin() + 4});
    auto bad = good;
    bad[3].seconds = 0;
    refused(bad);
    bad = good;
    bad[3].one_seconds = 0;
    refused(bad);
    bad = good;
    bad[3].threads = 1;
    refused(bad);
  }
}
