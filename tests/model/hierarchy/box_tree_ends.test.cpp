#include "detp/model/hierarchy/box_tree_ends.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/model/hierarchy/box_tree_boxes.hpp"
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

const CellKind cube{.side = {1, 1, 1}};
const CellKind face{.side = {1, 1, 0}, .touched = {0, 0, 1}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("around discs of mixed radii, sides are those of random discs, to 2 %" * doctest::test_suite("long")) {
    const std::vector<RadiusClass> mixed{{8, 0.01}, {2, 0.19}, {1, 0.5}, {0.1, 0.3}};
    const std::vector<RadiusClass> giants{{100, 0.02}, {1, 0.98}};
    for (const auto& classes : {mixed, giants}) {
      const BoxEnds ends(classes);
      for (const double side : {0.5, 4.0, 32.0, 256.0})
        for (const int discs : {2, 8, 60, 500}) {
          INFO("side ", side, ", discs ", discs);
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

  TEST_CASE("around few discs as large as the cell, sides equal those of random discs") {
    constexpr int discs = 5;
    constexpr double radius = 0.5;
    constexpr int sets = 40000;
    detp::support::RandomNumbers random(5);
    double sum = 0;
    for (int set = 0; set < sets; ++set) {
      double low = 2;
      double high = -2;
      for (int i = 0; i < discs; ++i) {
        const double x = random.uniform(0, 1);
        const double reach = radius * std::sqrt(1 - std::pow(random.uniform(0, 1), 2));
        low = std::min(low, x - reach);
        high = std::max(high, x + reach);
      }
      sum += (high - low) / sets;
    }
    CHECK(std::cbrt(CellBoxes(cube, radius)(discs).volume) == Approx(sum).epsilon(0.005));
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

  TEST_CASE("around m points uniform in a cell of side L, each side is L (m - 1)/(m + 1)") {
    const CellBoxes boxes(cube, 1e-12);
    const CellBoxes flat(face, 1e-12);
    for (const double m : {2.0, 3.0, 10.0, 64.0, 100.0, 1000.0}) {
      const double side = (m - 1) / (m + 1);
      CAPTURE(m);
      CHECK(boxes(m).products == Approx(3 * side * side).epsilon(4e-3));
      CHECK(boxes(m).volume == Approx(side * side * side).epsilon(6e-3));
      CHECK(flat(m).products == Approx(side * side).epsilon(4e-3));
      CHECK(flat(m).volume < 1e-9);
    }
    CHECK(boxes(1).products < 1e-20);
  }

  TEST_CASE("the products of all numbers of discs up to 64 are those of each number") {
    for (const CellKind& cell : {cube, face, CellKind{.side = {0.25, 0.5, 0.5}}})
      for (const double radius : {1e-5, 0.03, 0.4, 7.0}) {
        const CellBoxes boxes(cell, radius);
        std::array<double, 64> all;
        boxes.products(all);
        for (int m = 1; m <= 64; ++m) CHECK(all[m - 1] == boxes(m).products);
      }
  }

  TEST_CASE("the box around one disc has sides of π d/2 on average") {
    const double side = std::numbers::pi / 2 * 0.1;
    CHECK(CellBoxes(cube, 0.1)(1).products == Approx(3 * side * side).epsilon(0.01));
    CHECK(CellBoxes(face, 0.1)(1).volume == Approx(side * side * side).epsilon(0.01));
  }
}

TEST_SUITE("limit") {
  TEST_CASE("boxes around many discs fill the cell and extend beyond it by d") {
    CHECK(CellBoxes(cube, 0.1)(1e9).volume == Approx(std::pow(1.2, 3)).epsilon(0.01));
    CHECK(CellBoxes(face, 0.1)(1e9).volume == Approx(1.2 * 1.2 * 0.2).epsilon(0.01));
  }

  TEST_CASE("more discs have larger boxes, and so have larger discs") {
    for (const CellKind& cell : {cube, face, CellKind{.side = {1, 1, 1}, .touched = {1, 0, 1}},
                                 CellKind{.side = {1, 1, 1}, .touched = {2, 2, 2}}})
      for (double radius = 1e-5; radius < 1e5; radius *= 10) {
        double before = 0;
        for (double m = 1; m < 1e6; m *= 1.3) {
          const MeanBox box = CellBoxes(cell, radius)(m);
          CHECK(box.surface > 0.98 * before);
          CHECK(CellBoxes(cell, 1.5 * radius)(m).surface > box.surface);
          before = box.surface;
        }
      }
  }
}
