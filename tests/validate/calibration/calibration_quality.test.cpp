#include "detp/validate/calibration/calibration_quality.hpp"

#include <doctest/doctest.h>

#include <cmath>

using detp::validate::CalibrationQuality;

TEST_SUITE("known answer") {
  TEST_CASE("a calibration is doubtful if its error is large or if other programs took much of the time") {
    CHECK(CalibrationQuality{0.14, 0.95}.doubt().empty());
    CHECK(CalibrationQuality{0.22, 0.95}.doubt() == "its median error is 22 %, more than 15 %");
    CHECK(CalibrationQuality{0.05, 0.6}.doubt() == "other programs took 40 % of the time of its runs");
    CHECK(CalibrationQuality{0.3, 0.6}.doubt().find("; other programs") != std::string::npos);
  }

  TEST_CASE("the relative error is the standard deviation whose median is the median error") {
    // half of a normal distribution is within 0.6745 standard deviations
    CHECK(std::erf(0.6745 / std::sqrt(2.0)) == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(CalibrationQuality{0.06745, 1}.relative_error() == doctest::Approx(0.1));
    CHECK(CalibrationQuality{0.06745, 0.5}.relative_error() == doctest::Approx(0.5));
  }

  TEST_CASE("one without doubt is better than a doubtful one, else the one with the smaller error") {
    CHECK(CalibrationQuality{0.14, 0.95}.is_better_than({0.01, 0.5}));
    CHECK_FALSE(CalibrationQuality{0.01, 0.5}.is_better_than({0.14, 0.95}));
    CHECK(CalibrationQuality{0.04, 1}.is_better_than({0.05, 1}));
    CHECK(CalibrationQuality{0.2, 1}.is_better_than({0.3, 1}));
    CHECK_FALSE(CalibrationQuality{0.2, 1}.is_better_than({0.2, 1}));
  }
}
