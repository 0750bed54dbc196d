#include "detp/validate/picture/labels.hpp"

#include <doctest/doctest.h>

using namespace detp::validate;

TEST_SUITE("known answer") {
  TEST_CASE("labels are short, and round correctly") {
    CHECK(rays_label(1) == "1");
    CHECK(rays_label(50) == "50");
    CHECK(rays_label(100) == "1e2");
    CHECK(rays_label(300'000) == "3e5");
    CHECK(rays_label(12'345) == "1.23e4");
    CHECK(rays_label(99'999) == "1e5");
    CHECK(rays_label(1e18) == "1e18");
    CHECK(seconds_label(8.4e-4) == "0.84 ms");
    CHECK(seconds_label(0.1234) == "123 ms");
    CHECK(seconds_label(0.9994) == "999 ms");
    CHECK(seconds_label(0.9996) == "1 s");
    CHECK(seconds_label(12.34) == "12 s");
    CHECK(percent_label(0.0499) == "5 %");
    CHECK(percent_label(1.234) == "123 %");
    CHECK(percent_label(0.00034) == "0.034 %");
  }
}
