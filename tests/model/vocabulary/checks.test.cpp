#include "detp/model/vocabulary/checks.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include "support/not_a_length.hpp"

using namespace detp;
using doctest::Contains;

TEST_SUITE("bad input") {
  TEST_CASE("the message names the quantity, the rule and the value") {
    CHECK_THROWS_WITH_AS(require_positive("disc radius", -1), "disc radius must be > 0 and finite (got -1)",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_non_negative("path length", -0.5), "path length must be >= 0 and finite (got -0.5)",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_finite("x", support::infinity), "x must be finite (got inf)", std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_ratio("Q", 1), "Q must be between 0 and 1, both excluded (got 1)",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(require_count("rays", 2.5, 1, 1e18), "rays must be a whole number from 1 to 1e+18 (got 2.5)",
                         std::invalid_argument);
  }

  TEST_CASE("each check refuses values out of its range, and NaN") {
    for (const double bad : support::not_a_length) CHECK_THROWS_AS(require_positive("it", bad), std::invalid_argument);
    for (const double bad : support::not_a_size)
      CHECK_THROWS_AS(require_non_negative("it", bad), std::invalid_argument);
    for (const double bad : {support::not_a_number, support::infinity, -support::infinity})
      CHECK_THROWS_AS(require_finite("it", bad), std::invalid_argument);
    for (const double bad : support::not_a_ratio) CHECK_THROWS_AS(require_ratio("it", bad), std::invalid_argument);
    for (const double bad : support::not_a_count)
      CHECK_THROWS_AS(require_count("it", bad, 1, 1e18), std::invalid_argument);
    CHECK_THROWS_AS(require_count("it", 4, 5, 7), std::invalid_argument);
    CHECK_THROWS_AS(require_count("it", 8, 5, 7), std::invalid_argument);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("each check accepts values in its range, including the ends") {
    using limits = std::numeric_limits<double>;
    for (const double good : {limits::denorm_min(), 1.0, limits::max()}) {
      CHECK_NOTHROW(require_positive("it", good));
      CHECK_NOTHROW(require_non_negative("it", good));
      CHECK_NOTHROW(require_finite("it", -good));
    }
    CHECK_NOTHROW(require_non_negative("it", 0));
    CHECK_NOTHROW(require_ratio("it", limits::denorm_min()));
    CHECK_NOTHROW(require_ratio("it", 1 - limits::epsilon() / 2));
    for (const double good : {1.0, 2.0, 1e18}) CHECK_NOTHROW(require_count("it", good, 1, 1e18));
  }
}
