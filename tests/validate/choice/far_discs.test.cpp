#include "detp/validate/choice/far_discs.hpp"

#include <doctest/doctest.h>

#include "detp/sim/scene/open/uniform_discs.hpp"

using namespace detp;
using namespace detp::validate;

TEST_SUITE("known answer") {
  TEST_CASE("discs far outside the central box are counted, the others are near; without them none are far") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 10'000, 0.02, 1);
    CHECK_FALSE(find_far_discs(discs, box_of_centres(discs)));
    discs[10].centre = {0, 500, 0};
    discs[20].centre = {-500, 0, 0};
    const auto found = find_far_discs(discs, box_of_centres(discs));
    REQUIRE(found);
    CHECK(found->far == 2);
    CHECK(found->reach == doctest::Approx(1.8).epsilon(0.03));  // the central 90 % of a side of 2
    CHECK_FALSE(found->is_near(discs[10]));
    for (std::size_t i = 0; i < 10; ++i) CHECK(found->is_near(discs[i]));
  }

  TEST_CASE("the box of the centres of two discs has them as corners") {
    const std::vector<sim::Disc> discs{{.centre = {1, 5, 2}, .radius = 9}, {.centre = {3, 4, 2}, .radius = 9}};
    const sim::Box box = box_of_centres(discs);
    CHECK(box.low == glm::dvec3(1, 4, 2));
    CHECK(box.high == glm::dvec3(3, 5, 2));
  }
}

TEST_SUITE("limit") {
  TEST_CASE("of a few discs none is far, unless their centres are more than four diameters apart") {
    const std::vector<sim::Disc> one{{.radius = 1}};
    CHECK_FALSE(find_far_discs(one, box_of_centres(one)));
    std::vector<sim::Disc> two{{.radius = 1}, {.centre = {7, 0, 0}, .radius = 1}};
    CHECK_FALSE(find_far_discs(two, box_of_centres(two)));
  }
}
