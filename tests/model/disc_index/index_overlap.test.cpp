#include "detp/model/disc_index/index_overlap.hpp"

#include <doctest/doctest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using std::numbers::pi;

namespace {

/// Mean over unit vectors n of the product of √(1 - n_i²) over two axes, or over all three.
double mean_reach_product(int axes) {
  using Rule = boost::math::quadrature::gauss<double, 160>;
  return Rule::integrate(
      [axes](double height) {
        const double s2 = std::cos(height) * std::cos(height);
        const double around = Rule::integrate(
            [&](double turn) {
              const double along = s2 * std::cos(turn) * std::cos(turn);
              return std::sqrt((1 - along) * (1 - (s2 - along)));
            },
            0, pi / 2);
        return std::cos(height) * (axes == 3 ? std::cos(height) : 1) * around * 2 / pi;
      },
      0, pi / 2);
}

double sum_of_slabs(const SlabRuns& slabs, Centres centres) {
  double all = 0;
  for (std::size_t i = 0; i < slabs.size; ++i) {
    const auto place = static_cast<std::size_t>(centres);
    all += slabs.runs[i].count * (slabs.runs[i].centred[place] + slabs.runs[i].reached[place].planes);
  }
  return all;
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("mean products of the reaches of an isotropic disc") {
    CHECK(mean_reach_product_2 == Approx(mean_reach_product(2)).epsilon(1e-9));
    CHECK(mean_reach_product_3 == Approx(mean_reach_product(3)).epsilon(1e-9));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("weights of planes, integrated over a disc's reach, equal those of uniform centres") {
    for (const auto insertion : {Insertion::exact, Insertion::bounding_box}) {
      PlaneCrossings sum;
      constexpr int planes = 20'000;
      for (int i = 0; i < planes; ++i)  // one plane at d (1 + u)
        sum += 1.0 / planes * crossings({2, 1 + (i + 0.5) / planes, 0, 1}, Centres::low_face, insertion);
      const PlaneCrossings expected = uniform_crossings(pi / 4, insertion);
      CHECK(sum.planes == Approx(expected.planes).epsilon(1e-6));
      CHECK(sum.line_weight == Approx(expected.line_weight).epsilon(1e-6));
      CHECK(sum.corner_weight == Approx(expected.corner_weight).epsilon(1e-6));
    }
  }

  TEST_CASE("a long axis is crossed as endless cells are, for any disc") {
    for (const double x : {0.01, 0.3, 1.0, 7.0, 60.0, 70.0, 500.0}) {
      const PlaneCrossings found = crossings({1e6, 1, 1e6 - 2 * x, x}, Centres::uniform, Insertion::exact);
      CHECK(found.planes == Approx(pi / 2 * x).epsilon(2e-3));
      CHECK(found.line_weight == Approx(x).epsilon(2e-3));
      CHECK(found.corner_weight == 0);
    }
  }

  TEST_CASE("a single cell is crossed by no plane, and contains the disc") {
    for (const auto centres : {Centres::uniform, Centres::low_face, Centres::high_face}) {
      CHECK(crossings({1, 3, 1, 1}, centres, Insertion::exact).planes == 0);
      CHECK(sum_of_slabs(slab_runs({1, 3, 1, 1}, Insertion::exact), centres) == Approx(1).epsilon(1e-14));
    }
  }

  TEST_CASE("if whole cells fill an axis, both its faces are equal") {
    for (const double x : {0.1, 0.7, 2.3}) {
      const IndexAxis axis{16, 1, 16 - 2 * x, x};
      for (const auto insertion : {Insertion::exact, Insertion::bounding_box}) {
        const PlaneCrossings low = crossings(axis, Centres::low_face, insertion);
        const PlaneCrossings high = crossings(axis, Centres::high_face, insertion);
        CHECK(low.planes == Approx(high.planes).epsilon(1e-12));
        CHECK(low.line_weight == Approx(high.line_weight).epsilon(1e-12));
      }
    }
  }

  TEST_CASE("the slabs that a disc reaches are one more than the planes that it crosses") {
    for (const double cells : {1.0, 2.0, 5.0, 9.0, 40.0, 1000.0, 1e17})
      for (const double x : {0.05, 0.6, 1.7, 4.0, 20.0, 80.0}) {
        if (2 * x > cells) continue;
        const IndexAxis axis{cells, 1, cells - 2 * x, x};
        CAPTURE(cells);
        CAPTURE(x);
        for (const auto centres : {Centres::uniform, Centres::low_face, Centres::high_face})
          CHECK(sum_of_slabs(slab_runs(axis, Insertion::exact), centres) ==
                Approx(1 + crossings(axis, centres, Insertion::exact).planes).epsilon(1e-9));
      }
  }
}
