#include "detp/validate/map/map_summary.hpp"

#include <doctest/doctest.h>

#include "map_support.hpp"

using namespace detp;
using namespace detp::validate;

TEST_SUITE("known answer") {
  TEST_CASE("a cell agrees if the predicted technique was the fastest; overlapping ranges are within noise") {
    const TechniqueMap map = support::small_map();
    const CellVerdict same = map.rows[0].cells[0].verdict().value();
    CHECK(same.agrees);
    CHECK(same.slower == 0);
    const CellVerdict other = map.rows[0].cells[1].verdict().value();
    CHECK_FALSE(other.agrees);
    CHECK(other.slower == doctest::Approx(3));
    CHECK_FALSE(other.within_noise);
    const CellVerdict noisy = map.rows[1].cells[0].verdict().value();
    CHECK_FALSE(noisy.agrees);
    CHECK(noisy.slower == doctest::Approx(0.1));
    CHECK(noisy.within_noise);
  }

  TEST_CASE("agreement counts measured cells only, and lists the largest loss first") {
    const TechniqueMap map = support::small_map();
    const Agreement agreement = agreement_of(map);
    CHECK(agreement.cells == 3);
    CHECK(agreement.agree == 1);
    CHECK(agreement.share() == doctest::Approx(1.0 / 3));
    CHECK(agreement.within_noise() == 1);
    REQUIRE(agreement.disagreeing.size() == 2);
    CHECK(agreement.disagreeing[0].cell == &map.rows[0].cells[1]);
    CHECK(agreement.disagreeing[1].row == &map.rows[1]);
    CHECK(agreement.worst_slowdown == doctest::Approx(4));
    CHECK(agreement.mean_slowdown == doctest::Approx(std::cbrt(1 * 4 * 1.1)));
  }

  TEST_CASE("without a measured cell there is nothing to agree") {
    CHECK(agreement_of(TechniqueMap{}).cells == 0);
    CHECK(agreement_of(TechniqueMap{}).mean_slowdown == 1);
  }
}
