#include "detp/validate/calibration/calibration.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

using namespace detp;

TEST_SUITE("identity") {
  TEST_CASE("a key is read back from JSON as it was written") {
    const validate::CalibrationKey here = validate::this_machine();
    CHECK(validate::key_of(validate::to_json(here)) == here);
  }

  TEST_CASE("equal keys do not differ; each difference is named") {
    const validate::CalibrationKey here = validate::this_machine();
    CHECK(validate::difference(here, here).empty());
    validate::CalibrationKey other = here;
    other.threads += 1;
    CHECK(validate::difference(other, here).find("number of threads") != std::string::npos);
    other = here;
    other.instruction_set = "MMX";
    CHECK(validate::difference(other, here).find("instruction set is MMX, here it is") != std::string::npos);
    other = here;
    other.cost_model += 1;
    CHECK(validate::difference(other, here).find("cost model") != std::string::npos);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a key with a missing value is refused") {
    nlohmann::ordered_json json = validate::to_json(validate::this_machine());
    json.erase("cpu");
    CHECK_THROWS_AS(static_cast<void>(validate::key_of(json)), nlohmann::json::exception);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a calibration is doubtful if its error is large or if other programs took much of the time") {
    CHECK(validate::CalibrationQuality{0.14, 0.95}.doubt().empty());
    CHECK(validate::CalibrationQuality{0.22, 0.95}.doubt() == "its median error is 22 %, more than 15 %");
    CHECK(validate::CalibrationQuality{0.05, 0.6}.doubt() == "other programs took 40 % of the time of its runs");
    CHECK(validate::CalibrationQuality{0.3, 0.6}.doubt().find("; other programs") != std::string::npos);
  }

  TEST_CASE("the relative error is the standard deviation whose median is the median error") {
    // half of a normal distribution is within 0.6745 standard deviations
    CHECK(std::erf(0.6745 / std::sqrt(2.0)) == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(validate::CalibrationQuality{0.06745, 1}.relative_error() == doctest::Approx(0.1));
    CHECK(validate::CalibrationQuality{0.06745, 0.5}.relative_error() == doctest::Approx(0.5));
  }

  TEST_CASE("one without doubt is better than a doubtful one, else the one with the smaller error") {
    CHECK(validate::CalibrationQuality{0.14, 0.95}.is_better_than({0.01, 0.5}));
    CHECK_FALSE(validate::CalibrationQuality{0.01, 0.5}.is_better_than({0.14, 0.95}));
    CHECK(validate::CalibrationQuality{0.04, 1}.is_better_than({0.05, 1}));
    CHECK(validate::CalibrationQuality{0.2, 1}.is_better_than({0.3, 1}));
    CHECK_FALSE(validate::CalibrationQuality{0.2, 1}.is_better_than({0.2, 1}));
  }
}
