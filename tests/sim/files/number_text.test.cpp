#include "detp/sim/files/number_text.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace detp::sim;

TEST_SUITE("known answer") {
  TEST_CASE("numbers beyond the range of any type are infinite or zero, in any notation") {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const char* large : {"1e309", "1e5000", "10e404000", "+1E+99999", "0.001e6000", "1e99999999999999999999"})
      CHECK(number_in(large) == infinity);
    CHECK(number_in("-1e5000") == -infinity);
    CHECK(number_in("1" + std::string(6000, '0')) == infinity);
    for (const char* small : {"1e-400", "1e-6000", "1e-404000", "1000e-6000", "1e-99999999999999999999"})
      CHECK(number_in(small) == 0);
    CHECK(number_in("0." + std::string(6000, '0') + "1") == 0);
    CHECK(std::signbit(number_in("-1e-6000").value()));
    CHECK(number_in("0e999999") == 0);
    CHECK_FALSE(number_in("1e5000x").has_value());
  }
}
