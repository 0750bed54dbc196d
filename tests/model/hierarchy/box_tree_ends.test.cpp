#include "detp/model/hierarchy/box_tree_ends.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/random_workload.hpp"

using namespace detp;
using namespace detp::model::box_tree;
using doctest::Approx;

namespace {

/// The mean extent of sets of m discs with these radii, whose centres are uniform along a side.
double counted_extent(const std::vector<RadiusClass>& classes, double side, int discs, int sets) {
  support::RandomNumbers random(7);
  double sum = 0;
  for (int set = 0; set < sets; ++set) {
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    for (int i = 0; i < discs; ++i) {
      double place = random.uniform(0, 1);
      std::size_t which = 0;
      while (which + 1 < classes.size() && place >= classes[which].share) place -= classes[which++].share;
      const double x = random.uniform(0, side);
      const double reach = classes[which].radius * std::sqrt(1 - std::pow(random.uniform(0, 1), 2));
      low = std::min(low, x - reach);
      high = std::max(high, x + reach);
    }
    sum += high - low;
  }
  return sum / sets;
}

double predicted_extent(const BoxEnds& ends, double side, double discs) {
  return side + 2 * ends.largest_radius() - 2 * ends.row(side).missing(discs);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("around discs of mixed radii, sides are those of random discs, to 2 %") {
    const std::vector<RadiusClass> mixed{{8, 0.01}, {2, 0.19}, {1, 0.5}, {0.1, 0.3}};
    const std::vector<RadiusClass> giants{{100, 0.02}, {1, 0.98}};
    for (const auto& classes : {mixed, giants}) {
      const BoxEnds ends(classes);
      for (const double side : {0.5, 4.0, 32.0, 256.0})
        for (const int discs : {2, 8, 60, 500}) {
          CAPTURE(side);
          CAPTURE(discs);
          const double counted = counted_extent(classes, side, discs, 1'000'000 / discs);
          CHECK(predicted_extent(ends, side, discs) == Approx(counted).epsilon(0.02));
        }
    }
  }

  TEST_CASE("the extent of one disc has the mean and the variance of 2 r √(1 - u²)") {
    const std::vector<RadiusClass> classes{{3, 0.25}, {1, 0.75}};
    const BoxEnds ends(classes);
    CHECK(predicted_extent(ends, 5, 1) == Approx(1.5 * std::acos(-1) / 2));
    CHECK(ends.rms_radius() == Approx(std::sqrt(3)));
    CHECK(ends.extent_variance() == Approx(4 * (3 * 2.0 / 3 - std::pow(1.5 * std::acos(-1) / 4, 2))));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("one class of radii has the ends of equal radii") {
    for (const double radius : {1e-4, 0.01, 0.3, 5.0}) {
      const BoxEnds equal(radius);
      const BoxEnds one(std::vector<RadiusClass>{{radius, 1}});
      for (const double side : {1.0, 0.25, 0x1p-9})
        for (const double discs : {1.0, 3.0, 40.0, 1e3})
          CHECK(predicted_extent(one, side, discs) == Approx(predicted_extent(equal, side, discs)).epsilon(0.005));
    }
  }

  TEST_CASE("all numbers of discs at once are each of them") {
    const BoxEnds ends(std::vector<RadiusClass>{{2, 0.5}, {1, 0.5}});
    std::array<double, BoxEnds::most_exact> all;
    ends.row(0.5).missing_up_to(all);
    for (std::size_t i = 0; i < all.size(); ++i) CHECK(all[i] == ends.row(0.5).missing(static_cast<double>(i + 1)));
  }
}
