#include "detp/validate/map/map_summary.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

using namespace detp;
using namespace detp::validate;

TEST_SUITE("known answer") {
  TEST_CASE("edges of cells are the geometric means of neighbours; the outer cells are symmetric") {
    const std::vector<double> edges = cell_edges({1, 100, 1e6});
    REQUIRE(edges.size() == 4);
    CHECK(edges[0] == doctest::Approx(0.1));
    CHECK(edges[1] == doctest::Approx(10));
    CHECK(edges[2] == doctest::Approx(1e4));
    CHECK(edges[3] == doctest::Approx(1e8));
    CHECK(cell_edges({10})[0] * cell_edges({10})[1] == doctest::Approx(100));
    CHECK(cell_edges({10})[1] == doctest::Approx(10 * std::sqrt(10)));
  }

  TEST_CASE("checked axes have each value once, and rays ascend") {
    const MapAxes axes = checked({{1000, 10, 1000}, {{0.04, true}, {0.01, true}, {0.04, true}, {0.04, false}}});
    CHECK(axes.rays == std::vector<double>{10, 1000});
    CHECK(axes.radii == std::vector<Length>{{0.04, true}, {0.01, true}, {0.04, false}});
  }

  TEST_CASE("the default axes span the paper's figure: 1 % to 16 %, and at least 100 to 300 000 rays") {
    CHECK(default_map_rays().front() == 100);
    CHECK(default_map_rays().back() == 300'000);
    CHECK(default_map_radii().size() == 7);
    CHECK(default_map_radii().back() == Length{0.16, true});
    CHECK_NOTHROW(static_cast<void>(checked({default_map_rays(), default_map_radii()})));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("axes out of range are refused") {
    for (const double rays : {0.0, -1.0, 1.5, 1e19, std::numeric_limits<double>::quiet_NaN()})
      CHECK_THROWS_AS(static_cast<void>(checked({{rays}, {}})), std::invalid_argument);
    for (const double radius : {0.0, -1.0, std::numeric_limits<double>::infinity()})
      CHECK_THROWS_AS(static_cast<void>(checked({{}, {{radius}}})), std::invalid_argument);
  }

  TEST_CASE("axes with too many values are refused, and the message says how many fit") {
    std::vector<double> rays;
    for (std::size_t i = 1; i <= most_axis_values; ++i) rays.push_back(static_cast<double>(i));
    CHECK(checked({rays, {}}).rays.size() == most_axis_values);
    rays.push_back(1e6);
    CHECK_THROWS_WITH_AS(static_cast<void>(checked({rays, {}})), doctest::Contains("at most 40"), std::length_error);
  }
}
