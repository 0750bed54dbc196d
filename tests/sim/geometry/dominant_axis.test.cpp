#include "detp/sim/geometry/directions.hpp"

#include <doctest/doctest.h>

using detp::sim::dominant_axis;

TEST_SUITE("known answer") {
  TEST_CASE("the axis of the largest component, of either sign; if two are equal the lower axis") {
    CHECK(dominant_axis({0.8, -0.6, 0}) == 0);
    CHECK(dominant_axis({0.6, -0.8, 0}) == 1);
    CHECK(dominant_axis({0.1, 0.2, -0.9}) == 2);
    CHECK(dominant_axis({-0.5, 0.5, 0.5}) == 0);
    CHECK(dominant_axis({0, -0.5, 0.5}) == 1);
    CHECK(dominant_axis({0.5, 0, -0.5}) == 0);
  }
}
