#include "detp/model/optimum/optimal_ratio.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "support/high_precision.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using support::Exact;

TEST_SUITE("known answer") {
  TEST_CASE("two thirds for volumes, 1/sqrt(e) for surfaces, a half for curves") {
    CHECK(model::optimal_ratio(3) == doctest::Approx(2.0 / 3).epsilon(1e-15));
    CHECK(model::optimal_ratio(2) == doctest::Approx(std::exp(-0.5)).epsilon(1e-15));
    CHECK(model::optimal_ratio(1) == doctest::Approx(0.5).epsilon(1e-15));
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("(2/D)^(1/(D-2)) in 100 digits, especially near 2") {
    for (const double beyond : {-1.0, -0.3, -1e-3, -1e-9, -1e-15, 1e-15, 1e-12, 1e-8, 1e-4, 0.1, 0.7, 1.0}) {
      const double dimension = 2 + beyond;
      const Exact exact_beyond = Exact{dimension} - 2;
      const Exact expected = exact_beyond == 0 ? exp(Exact{-1} / 2) : pow(2 / Exact{dimension}, 1 / exact_beyond);
      CHECK(abs(model::optimal_ratio(dimension) / expected - 1) < 1e-15);
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("no other ratio gives a smaller value of the sum that it minimises") {
    for (const double dimension : {2.5, 3.0}) {
      const auto time = [&](double q) { return 1 / (q * q * (1 - std::pow(q, dimension - 2))); };
      const double best = time(model::optimal_ratio(dimension));
      for (double q = 0.01; q < 1; q += 0.001) CHECK(time(q) >= best * (1 - 1e-14));
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("an invalid dimension is refused by name") {
    for (const double bad : support::not_a_dimension)
      CHECK_THROWS_WITH_AS((void)model::optimal_ratio(bad), doctest::Contains("dimension"), std::invalid_argument);
  }
}
