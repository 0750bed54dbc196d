#include "detp/validate/map/map_labels.hpp"

#include <doctest/doctest.h>

#include "map_support.hpp"

using namespace detp;
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
    CHECK(radius_label({0.0025, true}) == "0.25 %");
    CHECK(radius_label({0.02, false}) == "0.02");
    CHECK(seconds_label(8.4e-4) == "0.84 ms");
    CHECK(seconds_label(0.1234) == "123 ms");
    CHECK(seconds_label(0.9994) == "999 ms");
    CHECK(seconds_label(0.9996) == "1 s");
    CHECK(seconds_label(12.34) == "12 s");
    CHECK(describe(support::small_map()) == "@small: 50 discs of dimension D = 3.00, isotropic lines");
    TechniqueMap mixed = support::small_map();
    mixed.field = sim::Field::mixed;
    CHECK(describe(mixed) == "@small: 50 discs of dimension D = 3.00, a mixed field");
  }
}
