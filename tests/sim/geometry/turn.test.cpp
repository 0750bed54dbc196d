#include "detp/sim/geometry/turn.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "detp/sim/geometry/random.hpp"

using namespace detp::sim;

TEST_SUITE("known answer") {
  TEST_CASE("an eighth of a turn and its multiples") {
    CHECK(turn(0).cos == 1);
    CHECK(turn(0).sin == 0);
    CHECK(turn(0.25).cos == 0);
    CHECK(turn(0.25).sin == 1);
    CHECK(turn(0.5).cos == -1);
    CHECK(turn(0.5).sin == 0);
    CHECK(turn(0.75).cos == 0);
    CHECK(turn(0.75).sin == -1);
    for (const double share : {0.125, 0.375, 0.625, 0.875}) {
      CHECK(std::abs(turn(share).cos) == doctest::Approx(std::sqrt(0.5)).epsilon(1e-15));
      CHECK(std::abs(turn(share).sin) == doctest::Approx(std::sqrt(0.5)).epsilon(1e-15));
    }
  }
}

TEST_SUITE("reference value") {
  TEST_CASE("cosine and sine are wrong by less than 3e-16") {
    static_assert(std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits);
    long double worst = 0;
    const auto compare = [&](double share) {
      const long double angle = 2 * std::numbers::pi_v<long double> * share;
      const Turn one = turn(share);
      worst = std::max({worst, std::abs(one.cos - std::cos(angle)), std::abs(one.sin - std::sin(angle))});
    };
    for (std::uint64_t i = 0; i < 5000; ++i)
      for (const double share : uniform4(7, Stream::tests, i)) compare(share);
    for (int eighth = 0; eighth < 8; ++eighth)
      for (const double beside : {0.0, 0x1p-53, 0x1p-40}) compare(eighth / 8.0 + beside);
    for (int eighth = 1; eighth <= 8; ++eighth) compare(eighth / 8.0 - 0x1p-53);
    CHECK(worst < 3e-16L);
  }
}
