#include "detp/model/disc_index/index_overlap.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/disc_index/index_cells.hpp"
#include "support/endless_cells.hpp"
#include "support/not_a_length.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using std::numbers::pi;
using support::few_rays;

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

double in_endless_cells(double x, Insertion insertion) {
  const double lines = insertion == Insertion::exact ? 1.5 * pi : 12 * mean_reach_product_2;
  return faces_seen(x, 1.5 * pi * x, lines * x * x, insertion);
}

double hits_per_test(double x, bool mailboxing) {
  // Cells with 1/1024 of the scene's side; the discs are small compared with the scene.
  const Workload workload = cube_workload(1e6, 1e6, x / 1024, 1);
  const Counts<double> counts = grid_counts(workload, {1024}, {.mailboxing = mailboxing});
  return counts.hits / counts.disc_tests;
}

const Workload some = {.rays = 1000, .samples = 100, .disc_radius = 0.01, .sphere_radius = 1, .box = {1, 1, 1}};

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
        INFO("cells ", cells, ", x ", x);
        for (const auto centres : {Centres::uniform, Centres::low_face, Centres::high_face})
          CHECK(sum_of_slabs(slab_runs(axis, Insertion::exact), centres) ==
                Approx(1 + crossings(axis, centres, Insertion::exact).planes).epsilon(1e-9));
      }
  }

  TEST_CASE("each hit takes at least one test of the disc, and at most one for each cell") {
    for (double x = 1e-3; x < 100; x *= 1.3)
      for (const auto insertion : {Insertion::exact, Insertion::bounding_box}) {
        const double cells = insertion == Insertion::exact ? support::overlapped_cells(x) : support::boxed_cells(x);
        CAPTURE(x);
        CHECK(in_endless_cells(x, insertion) >= 2 * pi * x * x);
        CHECK(in_endless_cells(x, insertion) >= 6);
        CHECK(in_endless_cells(x, insertion) <= 6 * cells);
        CHECK(in_endless_cells(1.01 * x, insertion) > in_endless_cells(x, insertion));
      }
  }

  TEST_CASE("more lines meet the bounding box of a disc than its cells") {
    for (double x = 1e-3; x < 100; x *= 1.3)
      CHECK(in_endless_cells(x, Insertion::bounding_box) > 0.999 * in_endless_cells(x, Insertion::exact));
  }
}

TEST_SUITE("limit") {
  TEST_CASE("a tiny disc lies in one cell with six faces, and a few in two cells with ten") {
    for (const auto insertion : {Insertion::exact, Insertion::bounding_box}) {
      CHECK(in_endless_cells(0, insertion) == 6);
      CHECK((in_endless_cells(1e-6, insertion) - 6) / 1e-6 == Approx(4 * 1.5 * pi).epsilon(1e-4));
    }
  }

  TEST_CASE("with small cells every tested disc is hit with mailboxes, two in nine without") {
    CHECK(in_endless_cells(1e5, Insertion::exact) == Approx(2 * pi * 1e10).epsilon(1e-4));
    CHECK(6 * support::overlapped_cells(1e5) / in_endless_cells(1e5, Insertion::exact) == Approx(4.5).epsilon(1e-4));
    CHECK(hits_per_test(30, false) == Approx(2.0 / 9).epsilon(0.04));
    CHECK(hits_per_test(30, true) > 0.85);
    CHECK(hits_per_test(30, true) < 1);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range are refused by name") {
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)faces_seen(bad, 1, 1, Insertion::exact), Contains("disc radius over cell side"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)faces_seen(1, bad, 1, Insertion::exact), Contains("planes"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)faces_seen(1, 1, bad, Insertion::exact), Contains("lines"), std::invalid_argument);
    }
  }

  TEST_CASE("numbers out of range are refused by name") {
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)octree_bytes(few_rays, {1}, {}, {.node = bad}), Contains("node"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)grid_bytes(few_rays, {1}, {}, {.cell = bad}), Contains("cell"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)grid_bytes(few_rays, {1}, {}, {.reference = bad}), Contains("reference"),
                           std::invalid_argument);
    }
    CHECK_THROWS_WITH_AS((void)octree_bytes(few_rays, {301}), Contains("depth"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)grid_bytes(few_rays, {0}), Contains("cells a side"), std::invalid_argument);
  }

  TEST_CASE("an invalid length is refused by name") {
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)published::octree_depth({bad}, 1), Contains("disc radius"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::octree_depth({1}, bad), Contains("scene side"), std::invalid_argument);
    }
  }

  TEST_CASE("a depth, a number of samples or a workload out of range is refused by name") {
    for (const int bad : {-1, 2097}) {
      CHECK_THROWS_WITH_AS((void)published::cells_per_line(bad), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::discs_per_cell(1, bad), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::tests_per_line(1, bad), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::octree_time(some, bad, 1), Contains("depth"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::balanced_octree_time(some, bad, 1), Contains("depth"),
                           std::invalid_argument);
    }
    for (const double bad : support::not_a_count) {
      Workload w = some;
      w.samples = bad;
      const Contains name("number of samples");
      CHECK_THROWS_WITH_AS((void)published::discs_per_cell(bad, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::tests_per_line(bad, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::octree_time(w, 1, 1), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::balanced_octree_time(w, 1, 1), name, std::invalid_argument);
    }
  }

  TEST_CASE("an invalid time of a test is refused by name") {
    for (const double bad : support::not_a_size) {
      const Contains name("time of a ray-disc test");
      CHECK_THROWS_WITH_AS((void)published::octree_time(some, 1, bad), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)published::balanced_octree_time(some, 1, bad), name, std::invalid_argument);
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a root alone is one node with all references") {
    CHECK(octree_bytes(few_rays, {0}) == 12 + 4e5);
    CHECK(grid_bytes(few_rays, {1}) == 16 + 4e5);
    CHECK(octree_bytes(few_rays, {0}, {}, {.node = 100, .reference = 8}) == 100 + 8e5);
  }

  TEST_CASE("a full octree has (8^(k+1) - 1)/7 nodes, a grid 8^k cells and one more") {
    Workload w = few_rays;
    w.samples = 1e15;
    for (int depth = 0; depth <= 4; ++depth) {
      CHECK(octree_bytes(w, {depth}, {}, {.node = 1, .reference = 0}) ==
            Approx((std::pow(8, depth + 1) - 1) / 7).epsilon(1e-12));
      CHECK(grid_bytes(w, {1 << depth}, {}, {.cell = 1, .reference = 0}) == std::pow(8, depth) + 1);
    }
  }

  TEST_CASE("references equal those of the counts") {
    for (const auto insertion : {Insertion::exact, Insertion::bounding_box}) {
      const IndexVariant variant{.insertion = insertion};
      CHECK(octree_bytes(few_rays, {5}, variant, {.node = 0, .reference = 1}) ==
            Approx(octree_counts(few_rays, {5}, variant).references).epsilon(1e-14));
      CHECK(grid_bytes(few_rays, {50}, variant, {.cell = 0, .reference = 1}) ==
            Approx(grid_counts(few_rays, {50}, variant).references).epsilon(1e-14));
    }
  }

  TEST_CASE("cells as wide as a disc are accepted; if one ulp narrower, the next larger ones are used") {
    for (int depth = 0; depth <= 300; ++depth)
      for (const double side : {2.0, 1.0, 0.7, 3e5}) {
        const double d = std::ldexp(side, -depth - 1);
        CHECK(published::octree_depth({d}, side) == depth);
        CHECK(published::octree_depth({std::nextafter(d, 1e9)}, side) == std::max(0, depth - 1));
        CHECK(published::octree_depth({std::nextafter(d, 0.0)}, side) == depth);
      }
  }

  TEST_CASE("the paper's scene of side 2: k = floor(-log2 d)") {
    CHECK(published::octree_depth({0.25}, 2) == 2);
    CHECK(published::octree_depth({0.01}, 2) == 6);
    CHECK(published::octree_depth({1}, 2) == 0);
  }

  TEST_CASE("discs wider than the scene need no level; the smallest double is a valid disc radius") {
    CHECK(published::octree_depth({1e300}, 1e-300) == 0);
    CHECK(published::octree_depth({std::numeric_limits<double>::denorm_min()}, 1) == 1073);
  }

  TEST_CASE("depth 4 of 1000 rays and 100 discs") {
    CHECK(published::cells_per_line(4) == 16);
    CHECK(published::discs_per_cell(100, 4) == 100 / 4096.0);
    CHECK(published::tests_per_line(100, 4) == 100 / 256.0);
    CHECK(published::balanced_octree_time(some, 4, 2) == 781.25);
    CHECK(published::octree_time(some, 4, 2) == 3125);
  }
}
