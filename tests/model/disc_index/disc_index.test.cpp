#include "detp/model/disc_index/disc_index.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "detp/model/lines/line_measure.hpp"
#include "support/endless_cells.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Approx;
using doctest::Contains;
using std::numbers::pi;
using support::few_rays;

namespace {

Workload in_box(std::array<double, 3> box, double disc = 0.5) {
  return {.rays = 1000, .samples = 100, .disc_radius = disc, .sphere_radius = 100, .box = box};
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("in a flat box a disc overlaps at least one cell and at most all cells") {
    for (const double disc : {1e-3, 0.1, 0.5, 3.0})
      for (int parts = 1; parts <= 400; ++parts) {
        const Cells cells = index_cells(in_box({1, 0, 1}, disc), parts);
        INFO("disc ", disc, ", parts ", parts);
        CHECK(cells.overlapped >= 1);
        CHECK(cells.overlapped <= cells.count());
        CHECK(grid_counts(in_box({1, 0, 1}, disc), {parts}).references >= 100);
      }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("a single cell is overlapped once by each disc, and contains them all") {
    for (const double disc : {1e-6, 0.01, 0.9}) {
      const Workload w = cube_workload(1000, 100, disc, 2);
      const Cells cells = index_cells(w, 1);
      CHECK(cells.overlapped == 1);
      CHECK(cells.count() == 1);
      CHECK(cells.side == 2 + 2 * disc);
      CHECK(octree_counts(w, {0}).references == 100);
      CHECK(octree_counts(w, {0}).placements == 0);
      CHECK(grid_counts(w, {1}).references == 100);
    }
  }

  TEST_CASE("lines that hit a cube cross 2^k of its cells, and one in 4^k crosses a given cell") {
    for (int depth = 0; depth <= 10; ++depth) {
      const Cells cells = index_cells(few_rays, std::ldexp(1, depth));
      const double hit = index_cells(few_rays, 1).crossing;
      CHECK(cells.count() == std::ldexp(1, 3 * depth));
      CHECK(cells.crossing == Approx(hit * std::ldexp(1, -2 * depth)).epsilon(1e-12));
      CHECK(grid_counts(few_rays, {1 << depth}).steps == Approx(1e4 * hit * std::ldexp(1, depth)).epsilon(1e-12));
    }
  }

  TEST_CASE("tests are rays times the probability of a cell times the references, steps times all cells") {
    for (const int parts : {1, 3, 10, 57, 400}) {
      const Cells cells = index_cells(few_rays, parts);
      const Counts<double> counts = grid_counts(few_rays, {parts});
      CHECK(counts.references == Approx(1e5 * cells.overlapped).epsilon(1e-14));
      CHECK(counts.placements == counts.references);
      CHECK(counts.disc_tests == Approx(1e4 * cells.crossing * counts.references).epsilon(1e-14));
      CHECK(counts.steps == Approx(1e4 * cells.crossing * cells.count()).epsilon(1e-14));
      CHECK(counts.hits == expected_hits(few_rays));
      CHECK(counts.nodes + counts.cull_tests + counts.listed + counts.culls + counts.sorted == 0);
    }
  }

  TEST_CASE("an octree tests the discs that a grid of its leaves tests") {
    for (int depth = 0; depth <= 12; ++depth) {
      const Counts<double> tree = octree_counts(few_rays, {depth});
      const Counts<double> grid = grid_counts(few_rays, {1 << depth});
      CHECK(tree.disc_tests == grid.disc_tests);
      CHECK(tree.references == grid.references);
      CHECK(tree.hits == grid.hits);
      CHECK(tree.steps == 0);
    }
  }

  TEST_CASE("if no node is empty, a line visits 2^(k+1) - 1 nodes") {
    Workload w = few_rays;
    w.samples = 1e15;
    const double hit = index_cells(w, 1).crossing;
    for (int depth = 0; depth <= 7; ++depth)  // in deeper octrees a disc of 0.01 need not reach the corner cells
      CHECK(octree_counts(w, {depth}).nodes == Approx(1e4 * hit * (std::ldexp(2, depth) - 1)).epsilon(1e-12));
  }

  TEST_CASE("… and with restarts (k + 1) 2^k") {
    Workload w = few_rays;
    w.samples = 1e15;
    const double hit = index_cells(w, 1).crossing;
    for (int depth = 0; depth <= 7; ++depth)  // in deeper octrees a disc of 0.01 need not reach the corner cells
      CHECK(octree_counts(w, {depth, Traversal::restart}).nodes ==
            Approx(1e4 * hit * (depth + 1) * std::ldexp(1, depth)).epsilon(1e-12));
  }

  TEST_CASE("a variant changes only its own counts") {
    for (int depth = 1; depth <= 9; ++depth) {
      const Counts<double> plain = octree_counts(few_rays, {depth});
      Counts<double> once = octree_counts(few_rays, {depth}, {.mailboxing = true});
      CHECK(once.disc_tests < plain.disc_tests);
      CHECK(once.disc_tests > once.hits);
      once.disc_tests = plain.disc_tests;
      CHECK(once == plain);
      CHECK(octree_counts(few_rays, {depth, Traversal::front_to_back}) == plain);
      Counts<double> anew = octree_counts(few_rays, {depth, Traversal::restart});
      CHECK(anew.nodes > plain.nodes);
      anew.nodes = plain.nodes;
      CHECK(anew == plain);
      const Counts<double> boxed = octree_counts(few_rays, {depth}, {.insertion = Insertion::bounding_box});
      CHECK(boxed.references > plain.references);
      CHECK(boxed.nodes >= plain.nodes);
      CHECK(boxed.hits == plain.hits);
    }
  }

  TEST_CASE("tests with mailboxes change steadily with the radius") {
    const auto tests_at = [](double radius) {
      Workload w = few_rays;
      w.disc_radius = radius;
      return octree_counts(w, {6}, {.mailboxing = true}).disc_tests;
    };
    for (double radius = 0.004; radius < 0.2; radius *= 1.01) {
      CAPTURE(radius);
      const double growth = tests_at(1.01 * radius) / tests_at(radius);
      CHECK(growth > 1);
      CHECK(growth < 1.03);
    }
  }

  TEST_CASE("octree_counts for all depths gives the counts of each depth") {
    const auto depths = octree_counts_by_depth(few_rays, {7});
    REQUIRE(depths.size() == 8);
    for (int depth = 0; depth <= 7; ++depth) CHECK(depths[depth] == octree_counts(few_rays, {depth}));
  }

  TEST_CASE("octrees are counted one depth after the other until the visit returns false") {
    int depth = 0;
    for_each_octree_depth(few_rays, {7}, {}, [&](const Counts<double>& counts) {
      CHECK(counts == octree_counts(few_rays, {depth}));
      return ++depth < 4;
    });
    CHECK(depth == 4);
  }

  TEST_CASE("placements of an octree are its references at all levels below the root") {
    double references = 0;
    for (int depth = 1; depth <= 8; ++depth) {
      references += octree_counts(few_rays, {depth}).references;
      CHECK(octree_counts(few_rays, {depth}).placements == Approx(references).epsilon(1e-14));
    }
  }

  TEST_CASE("many small cells are overlapped like endless ones") {
    const Cells cells = index_cells(few_rays, 1024);
    CHECK(cells.overlapped == Approx(support::overlapped_cells(0.01 / cells.side)).epsilon(0.02));
    CHECK(index_cells(cube_workload(1, 1, 1e-5, 2), 4096).overlapped ==
          Approx(support::overlapped_cells(1e-5 * 4096 / 2.00002)).epsilon(1e-3));
  }

  TEST_CASE("occupied cells: at most all cells, at most the references, and all of them for many samples") {
    support::RandomNumbers random(21);
    for (int run = 0; run < 500; ++run) {
      auto [w, unused] = support::random_workload(random);
      w.dimension = random.uniform(2, 3);
      const Cells cells = index_cells(w, static_cast<double>(random.whole(1, 500)));
      const double occupied = occupied_cells(w, cells);
      REQUIRE(occupied > 0);
      REQUIRE(occupied <= cells.count() * (1 + 1e-12));
      REQUIRE(occupied <= w.samples * cells.overlapped * (1 + 1e-12));
      REQUIRE(cells.overlapped >= 1);
      REQUIRE(cells.overlapped <= cells.count());
    }
    Workload w = few_rays;
    w.samples = 1e18;
    CHECK(occupied_cells(w, index_cells(w, 10)) == Approx(1000).epsilon(1e-12));
    w.samples = 1;
    CHECK(occupied_cells(w, index_cells(w, 1e5)) == Approx(index_cells(w, 1e5).overlapped).epsilon(1e-9));
  }

  TEST_CASE("samples on surfaces occupy fewer cells than samples in the volume") {
    const Workload faces = cube_workload(1e4, 1e6, 0.001, 2, 2);
    const Workload volume = cube_workload(1e4, 1e6, 0.001, 2, 3);
    for (const double parts : {16.0, 64.0, 256.0})
      CHECK(occupied_cells(faces, index_cells(faces, parts)) < occupied_cells(volume, index_cells(volume, parts)));
    // Six faces of side 2 cross at most 1.5 (A/a²) cells.
    const Cells cells = index_cells(faces, 16);
    CHECK(occupied_cells(faces, cells) <= 1.5 * 24 / (cells.side * cells.side));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a flat or long box has as many cells along each side as are needed") {
    CHECK(index_cells(in_box({7, 3, 1}), 8).along == std::array<double, 3>{8, 4, 2});
    CHECK(index_cells(in_box({7, 7, 0}), 8).along == std::array<double, 3>{8, 8, 1});
    CHECK(index_cells(in_box({0, 0, 9}), 5).along == std::array<double, 3>{1, 1, 5});
    CHECK(index_cells(in_box({7, 3.01, 1}), 8).along == std::array<double, 3>{8, 5, 2});
    CHECK(index_cells(in_box({7, 3, 1}), 8).side == 1);
  }

  TEST_CASE("two cells a side: a disc in the middle overlaps 1 + 3 (π/2) x f and more, f the share of inner planes") {
    const Workload w = in_box({7, 7, 7});
    const Cells cells = index_cells(w, 2);  // cells of side 4; the centres lie in the middle 7 of 8 units
    const double plane = pi / 2 * (0.5 / 4) * (4.0 / 7);
    CHECK(cells.overlapped == Approx(1 + 3 * plane + 3 * plane * plane / (pi / 2)).epsilon(1e-14));
    CHECK(cells.crossing == Approx(6 * 16 / (4 * pi * 1e4)).epsilon(1e-14));
  }

  TEST_CASE("segments meet a cell by its volume and surface") {
    Workload w = in_box({7, 7, 7});
    w.path_length = 2;
    CHECK(index_cells(w, 2).crossing == Approx((64 + 2 * 96 / 4.0) / 512).epsilon(1e-14));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("numbers out of range are refused by name") {
    for (const int bad : {-1, 301})
      CHECK_THROWS_WITH_AS((void)octree_counts(few_rays, {bad}), Contains("depth"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)octree_counts(few_rays, {4, Traversal::neighbour_links}), Contains("neighbour links"),
                         std::invalid_argument);
    for (const int bad : {0, -1, 1'000'000'001})
      CHECK_THROWS_WITH_AS((void)grid_counts(few_rays, {bad}), Contains("cells a side"), std::invalid_argument);
    for (const double bad : support::not_a_length)
      CHECK_THROWS_WITH_AS((void)index_cells(few_rays, bad), Contains("cells along the longest side"),
                           std::invalid_argument);
  }

  TEST_CASE("a workload out of range is refused by name") {
    for (const double bad : support::not_a_count) {
      Workload w = few_rays;
      w.rays = bad;
      const Contains name("number of rays");
      CHECK_THROWS_WITH_AS((void)octree_counts(w, {3}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)grid_counts(w, {3}), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)index_cells(w, 3), name, std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)occupied_cells(w, {.side = 1}), name, std::invalid_argument);
    }
    for (const double bad : support::not_a_length)
      CHECK_THROWS_WITH_AS((void)occupied_cells(few_rays, {.side = bad}), Contains("cell side"), std::invalid_argument);
  }
}
