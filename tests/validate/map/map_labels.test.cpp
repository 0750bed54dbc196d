#include "detp/validate/map/map_summary.hpp"

#include <doctest/doctest.h>

#include "map_support.hpp"

using namespace detp;
using namespace detp::validate;

TEST_SUITE("known answer") {
  TEST_CASE("labels of radii are short; a map is described by its scene") {
    CHECK(radius_label({0.0025, true}) == "0.25 %");
    CHECK(radius_label({0.02, false}) == "0.02");
    CHECK(describe(support::small_map()) == "@small: 50 discs of dimension D = 3.00, isotropic lines");
    TechniqueMap mixed = support::small_map();
    mixed.field = sim::Field::mixed;
    CHECK(describe(mixed) == "@small: 50 discs of dimension D = 3.00, a mixed field");
  }
}
