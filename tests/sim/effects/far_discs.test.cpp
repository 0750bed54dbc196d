#include "detp/sim/effects/far_discs.hpp"

#include <doctest/doctest.h>

#include "detp/sim/open/uniform_discs.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

sim::Problem problem_of(const std::vector<sim::Disc>& discs) { return sim::make_problem_without_rays(discs, 1000); }

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("discs far outside the central box are counted, the others are near; without them none are far") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 10'000, 0.02, 1);
    CHECK_FALSE(find_far_discs(problem_of(discs)));
    discs[10].centre = {0, 500, 0};
    discs[20].centre = {-500, 0, 0};
    const auto found = find_far_discs(problem_of(discs));
    REQUIRE(found);
    CHECK(found->far == 2);
    CHECK(found->reach == doctest::Approx(1.8).epsilon(0.03));  // the central 90 % of a side of 2
    CHECK_FALSE(found->is_near(discs[10]));
    for (std::size_t i = 0; i < 10; ++i) CHECK(found->is_near(discs[i]));
  }
}

TEST_SUITE("limit") {
  TEST_CASE("of a few discs none is far, unless their centres are more than four diameters apart") {
    const std::vector<sim::Disc> one{{.radius = 1}};
    CHECK_FALSE(find_far_discs(problem_of(one)));
    std::vector<sim::Disc> two{{.radius = 1}, {.centre = {7, 0, 0}, .radius = 1}};
    CHECK_FALSE(find_far_discs(problem_of(two)));
  }
}
