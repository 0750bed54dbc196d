#include "detp/validate/calibration/cost_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/validate/statistics/statistics.hpp"

using namespace detp;

namespace {

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
