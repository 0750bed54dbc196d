#include "detp/validate/choice/analysis.hpp"

#include <doctest/doctest.h>

using namespace detp;
using namespace detp::validate;

TEST_SUITE("known answer") {
  TEST_CASE("the error of a predicted time is split into counts and unit costs; the costliest wrong count is named") {
    const UnitCosts costs{.cull_test = 2, .disc_test = 1};
    Prediction predicted{{Technique::sphere_cache, SphereCacheParameters{}}, {.cull_tests = 10, .disc_tests = 100}};
    predicted.time = price(predicted.counts, costs, predicted.candidate.technique);  // 120
    const PredictionError error = prediction_error(predicted, {.cull_tests = 20, .disc_tests = 20}, 30, costs);
    CHECK(error.seconds == doctest::Approx(4));
    CHECK(error.counts == doctest::Approx(2));
    CHECK(error.unit_costs == doctest::Approx(2));
    CHECK(error.worst == "disc_tests");
    CHECK(error.worst_ratio == doctest::Approx(5));
  }

  TEST_CASE("if all counts are right, only the unit costs are wrong") {
    const UnitCosts costs{.index_test = 3, .step = 1};
    Prediction predicted{{Technique::grid, GridParameters{4}}, {.disc_tests = 10, .steps = 5}};
    predicted.time = price(predicted.counts, costs, predicted.candidate.technique);  // 35
    const PredictionError error = prediction_error(predicted, {.disc_tests = 10, .steps = 5}, 7, costs);
    CHECK(error.counts == doctest::Approx(1));
    CHECK(error.unit_costs == doctest::Approx(5));
    CHECK(error.worst_ratio == 1);
  }
}
