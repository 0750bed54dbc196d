#include "detp/model/hierarchy/box_tree_nodes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/hierarchy/box_tree.hpp"
#include "detp/model/hierarchy/box_tree_boxes.hpp"
#include "detp/model/hierarchy/box_tree_expected.hpp"
#include "detp/model/lines/line_measure.hpp"

using namespace detp;
using doctest::Approx;
using namespace detp::model::box_tree;

namespace {

/// Cubes of side m^(1/3) (m - 1)/(m + 1) / 100 around m centres, in a cube of side 1; discs with half extents `extent` d.
Workload in_cubes(double extent, double disc_radius) {
  Workload w = cube_workload(1000, 1e6, disc_radius, 1);
  for (double m = 1 << 20; m >= 16; m /= 2) {
    const double side = std::cbrt(m) / 100 * (m - 1) / (m + 1);
    const double grown = 2 * extent;
    w.nodes.push_back(
        {.samples = m,
         .edges = 3 * side,
         .surface = {6 * side * side, 12 * side * grown, 6 * grown * grown},
         .squares = {3 * side * side, 6 * side * grown, 3 * grown * grown},
         .volume = {std::pow(side, 3), 3 * side * side * grown, 3 * side * grown * grown, std::pow(grown, 3)}});
  }
  NodeBoxes single;
  single.samples = 1;
  single.surface[2] = 6 * 4 * extent * extent;
  single.squares[2] = 3 * 4 * extent * extent;
  single.volume[3] = 8 * std::pow(extent, 3);
  w.nodes.push_back(single);
  return w;
}

struct Total {
  double inner = 0;
  double leaves = 0;
  double discs = 0;
};

Total total(int dimension, double samples, double radius, int leaf) {
  Total sum;
  for (const LevelNodes& level : expected_binary_tree(dimension, samples, radius, leaf)) {
    sum.inner += level.inner.count;
    for (const Leaves& leaves : level.leaves) {
      sum.leaves += leaves.count;
      sum.discs += leaves.count * leaves.discs;
    }
  }
  return sum;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("nodes of cubes have the crossing probability of the cubes, at, between and below the given sizes") {
    for (const double path_length : {0.0, 0.3})
      for (const double d : {1e-4, 0.01}) {
        Workload w = in_cubes(0.9, d);
        w.path_length = path_length;
        const Valid<Workload> valid(w);
        const model::box_tree::ClusteredNodes nodes(valid, Engine::plain, 0);
        for (const double m : {1.0, 2.0, 3.0, 10.0, 16.0, 64.0, 100.0, 5000.0}) {
          const double side = std::cbrt(m) / 100 * (m - 1) / (m + 1) + 2 * 0.9 * d;
          CAPTURE(m);
          CHECK(nodes.crossing(m) ==
                Approx(model::crossing_probability(w, side * side * side, 6 * side * side)).epsilon(0.02));
        }
      }
  }

  TEST_CASE("larger nodes are crossed by more rays, larger discs too") {
    const Valid<Workload> w(in_cubes(0.9, 0.001));
    const Valid<Workload> larger = with_disc_radius(w, 0.002);
    const model::box_tree::ClusteredNodes nodes(w, Engine::simd, 1e-6);
    const model::box_tree::ClusteredNodes large(larger, Engine::simd, 1e-6);
    double before = 0;
    for (double m = 1; m < 1e6; m *= 1.3) {
      const double p = nodes.crossing(m);
      CHECK(p > before);
      CHECK(p <= 1);
      CHECK(large.crossing(m) >= p);
      before = p;
    }
  }

  TEST_CASE("boxes of uniform samples leave the counts of the box tree, to a twentieth") {
    Workload w = in_cubes(0.9, 0.002);
    const BoxTreeParameters tree{8, 16};
    const auto with = model::box_tree_counts(w, tree, Engine::plain);
    w.nodes.clear();
    const auto without = model::box_tree_counts(w, tree, Engine::plain);
    CHECK(with.cull_tests == Approx(without.cull_tests).epsilon(0.05));
    CHECK(with.disc_tests == Approx(without.disc_tests).epsilon(0.05));
  }

  TEST_CASE("denser rays multiply small probabilities, hits by their own density; certainty stays") {
    CHECK(model::at_density(1, 5) == 1);
    CHECK(model::at_density(0, 5) == 0);
    CHECK(model::at_density(0.3, 1) == 0.3);
    CHECK(model::at_density(1e-9, 5) == Approx(5e-9));
    CHECK(model::at_density(0.5, 0.1) == Approx(0.05 / 0.55));
    Workload w = cube_workload(1000, 1000, 0.01, 1);
    const double hits = model::expected_hits(w);
    const auto tests = model::box_tree_counts(w, {8, 16}, Engine::simd);
    w.hit_ratio = 3;
    CHECK(model::expected_hits(w) == Approx(3 * hits));
    CHECK(model::box_tree_counts(w, {8, 16}, Engine::simd).disc_tests == tests.disc_tests);
    w.ray_density = 2;
    CHECK(model::expected_hits(w) == Approx(6 * hits));
    CHECK(model::box_tree_counts(w, {8, 16}, Engine::simd).disc_tests == Approx(2 * tests.disc_tests).epsilon(0.1));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("boxes around samples must be finite, of falling sizes, the last of one sample") {
    const Workload good = in_cubes(0.9, 0.01);
    CHECK_NOTHROW(check(good));
    const auto refused = [&](auto&& change) {
      Workload w = good;
      change(w);
      CHECK_THROWS_AS(check(w), std::invalid_argument);
    };
    refused([](Workload& w) { w.nodes.pop_back(); });
    refused([](Workload& w) { w.nodes.erase(w.nodes.begin(), w.nodes.end() - 1); });
    refused([](Workload& w) { w.nodes[3].samples = w.nodes[2].samples; });
    refused([](Workload& w) { w.nodes[3].samples = NAN; });
    refused([](Workload& w) { w.nodes[3].edges = -1; });
    refused([](Workload& w) { w.nodes[3].surface[1] = NAN; });
    refused([](Workload& w) { w.nodes[3].squares[0] = INFINITY; });
    refused([](Workload& w) { w.nodes[3].volume[3] = -1; });
    refused([](Workload& w) { w.ray_density = 0; });
    refused([](Workload& w) { w.hit_ratio = NAN; });
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the two halves of a cell share its samples, and each kind of cell has its share of them") {
    for (const int dimension : {2, 3}) {
      const auto& kinds = cell_kinds(dimension, 1e5);
      for (std::size_t i = 0; i < kinds.size(); ++i) {
        const CellKind& cell = kinds[i];
        if (cell.child[0] == 0 || cell.cells == 0) continue;
        INFO("dimension ", dimension, ", i ", i);
        CHECK(cell.part[0] + cell.part[1] == Approx(1).epsilon(1e-15));
        CHECK(kinds[cell.child[0]].share == Approx(cell.part[0] * cell.share).epsilon(1e-15));
        CHECK(kinds[cell.child[1]].share == Approx(cell.part[1] * cell.share).epsilon(1e-15));
        for (const auto child : cell.child) CHECK(child > i);
      }
    }
  }

  TEST_CASE("cells of one size hold all samples: in a cube, and on its faces") {
    for (const CellKind& cell : cell_kinds(3, 1e5)) CHECK(cell.cells * cell.share == 1);
    // Halved six times across each axis, 64 cells a side: cells on faces, at edges and at corners.
    double share = 0;
    for (const CellKind& cell : cell_kinds(2, 1e5))
      if (cell.side[0] == 0x1p-6 && cell.side[1] == 0x1p-6 && (cell.side[2] == 0 || cell.side[2] == 0x1p-6))
        share += cell.cells * cell.share;
    CHECK(share == Approx(1).epsilon(1e-12));
  }

  TEST_CASE("the curve's smallest cells have 1/64 of the side below 8192 samples, else 1/1024") {
    for (const int dimension : {2, 3})
      for (const auto& [samples, side] : {std::pair{8191.0, 0x1p-6}, {8192.0, 0x1p-10}})
        for (const CellKind& cell : cell_kinds(dimension, samples)) {
          const bool smallest = cell.side[0] == side && cell.side[1] == side;
          CHECK(cell.side[0] >= side);
          if (cell.last) CHECK(smallest);
          if (smallest && dimension == 3 && cell.side[2] == side) CHECK(cell.last);
        }
  }

  TEST_CASE("the leaves hold all samples, and there is one more of them than of inner nodes") {
    for (const int dimension : {2, 3})
      for (const double samples : {300.0, 5000.0, 3e5})
        for (const double radius : {1e-4, 1e-2, 0.1})
          for (const int leaf : {1, 2, 7, 31, 64, 100}) {
            const Total sum = total(dimension, samples, radius, leaf);
            INFO("dimension ", dimension, ", samples ", samples, ", radius ", radius, ", leaf ", leaf);
            CHECK(sum.discs == Approx(samples).epsilon(0.03));
            CHECK(sum.leaves == Approx(sum.inner + 1).epsilon(0.05));
          }
  }
}

TEST_SUITE("limit") {
  TEST_CASE("each point has its leaf if leaves hold one; of discs larger than the cube, 64 share a leaf") {
    CHECK(total(3, 1e4, 1e-9, 1).leaves == Approx(1e4).epsilon(0.03));
    const Total large = total(3, 1e4, 10, 1);
    CHECK(large.discs / large.leaves == Approx(48).epsilon(0.35));
  }
}
