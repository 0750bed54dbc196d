#include "detp/validate/map/technique_map.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

const Workload workload_in_cell = cube_workload(1000, 1000, 0.02, 1);
constexpr UnitCosts no_costs{.cull_test = 0, .disc_test = 0, .index_test = 0, .step = 0, .node = 0};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("the estimate is the ranking, without disabled techniques") {
    const auto ranking = model::rank(workload_in_cell, built_in_unit_costs());
    const Choice all = choose_for_cell({.workload = workload_in_cell}, built_in_unit_costs());
    CHECK(all.best().candidate == ranking.front().candidate);
    CHECK(all.candidates.size() == ranking.size());
    const Technique first = ranking.front().candidate.technique;
    const Choice rest = choose_for_cell({.workload = workload_in_cell, .disabled = {first}}, built_in_unit_costs());
    CHECK(rest.candidates.size() == ranking.size() - 1);
    for (const Prediction& one : ranking) {
      const auto best = model::best_of(one.candidate.technique, workload_in_cell, built_in_unit_costs());
      if (one.candidate.technique != first) CHECK(rest.best().time.total() <= 1.01 * best.value().time.total());
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("costs of 0 and a list that disables everything are refused") {
    CHECK_THROWS_WITH_AS(static_cast<void>(choose_for_cell({.workload = workload_in_cell}, no_costs)),
                         doctest::Contains("0 s"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(static_cast<void>(choose_for_cell(
                             {.workload = workload_in_cell, .disabled = {all_techniques.begin(), all_techniques.end()}},
                             built_in_unit_costs())),
                         doctest::Contains("no technique is left"), std::invalid_argument);
  }

  TEST_CASE("a stop request gives no half ranking") {
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_AS(static_cast<void>(choose_for_cell({.workload = workload_in_cell, .stop = stop.get_token()},
                                                      built_in_unit_costs())),
                    sim::Stopped);
  }
}
