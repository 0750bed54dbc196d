#include "detp/model/disc_index/index_cells.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <stdexcept>

#include "detp/model/disc_index/disc_index.hpp"
#include "support/endless_cells.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using std::numbers::pi;

namespace {

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

}  // namespace

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

TEST_SUITE("identity") {
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

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range are refused by name") {
    for (const double bad : support::not_a_size) {
      CHECK_THROWS_WITH_AS((void)faces_seen(bad, 1, 1, Insertion::exact), Contains("disc radius over cell side"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)faces_seen(1, bad, 1, Insertion::exact), Contains("planes"), std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)faces_seen(1, 1, bad, Insertion::exact), Contains("lines"), std::invalid_argument);
    }
  }
}
