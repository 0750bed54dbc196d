#include "detp/validate/choice/pilot.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace detp;
using validate::usual_shape;

TEST_SUITE("known answer") {
  TEST_CASE("leaves are 24 (discs/rays)^0.3, a power of two from 8 to 512") {
    CHECK(usual_shape(1000, 1000) == BoxTreeParameters{8, 32});
    CHECK(usual_shape(1000, 16'000) == BoxTreeParameters{8, 64});
    CHECK(usual_shape(4000, 1000) == BoxTreeParameters{8, 16});
    CHECK(usual_shape(1, 1e18) == BoxTreeParameters{8, 512});
    CHECK(usual_shape(1e18, 1) == BoxTreeParameters{8, 8});
  }

  TEST_CASE("leaves are smaller where tests are slower than placing, within limits") {
    CHECK(usual_shape(1000, 1000, 8) == BoxTreeParameters{8, 8});
    CHECK(usual_shape(1000, 16'000, 32) == BoxTreeParameters{8, 32});
    CHECK(usual_shape(1000, 16'000, 1024) == BoxTreeParameters{8, 128});
    CHECK(usual_shape(1000, 16'000, std::numeric_limits<double>::infinity()) == BoxTreeParameters{8, 128});
    CHECK(usual_shape(1000, 16'000, 0) == usual_shape(1000, 16'000, 1));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers that are no numbers of rays and discs are refused") {
    CHECK_THROWS_AS(static_cast<void>(usual_shape(0, 10)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(usual_shape(10, 0.5)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(usual_shape(10, 10, std::nan(""))), std::invalid_argument);
  }
}
