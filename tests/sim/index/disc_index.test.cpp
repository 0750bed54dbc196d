#include "detp/sim/index/disc_index.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/indexed.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using support::search_grid;
using support::search_octree;

namespace {

std::vector<IndexVariant> all_variants() {
  std::vector<IndexVariant> all;
  for (const Insertion insertion : {Insertion::exact, Insertion::bounding_box})
    for (const bool mailboxing : {false, true}) all.push_back({insertion, mailboxing});
  return all;
}

/// Discs of two radii; lines and segments, some along the axes and in the planes between cells.
struct Setting {
  std::vector<Disc> discs;
  std::vector<Ray> rays;
};

Setting make_setting() {
  Setting setting{uniform_discs(Body::cube, 2, 1000, 0.03, 5), {}};
  for (std::size_t i = 0; i < setting.discs.size(); i += 7) setting.discs[i].radius = 0.3;
  setting.rays = LineField(enclosing_sphere(setting.discs), 6).lines(0, 1000);
  for (std::size_t i = 0; i < setting.rays.size(); ++i) {
    if (i % 2 == 0) setting.rays[i].length = 0.8;
    if (i % 5 == 0) setting.rays[i].direction = glm::dvec3{i % 3 == 0, i % 3 == 1, i % 3 == 2};
    if (i % 10 == 0) setting.rays[i].origin = glm::dvec3{0};
  }
  return setting;
}

const Setting& setting() {
  static const Setting made = make_setting();
  return made;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("all variants find the same hits") {
    const Problem problem = make_problem(setting().rays, setting().discs);
    const Outcome expected = support::truth_of(problem);
    REQUIRE(expected.total_hits > 1000);
    for (const IndexVariant& variant : all_variants()) {
      for (const Traversal traversal :
           {Traversal::top_down, Traversal::front_to_back, Traversal::restart, Traversal::neighbour_links})
        for (const int depth : {0, 1, 4}) {
          CAPTURE(name(traversal));
          CHECK(search_octree(problem, {depth, traversal}, variant, {.pairs = true}).pairs == expected.pairs);
        }
      for (const int cells : {1, 7, 20})
        CHECK(search_grid(problem, {cells}, variant, {.pairs = true}).pairs == expected.pairs);
    }
  }

  TEST_CASE("mailboxes and restarts change only their own counts of tests and visits") {
    const Problem problem = make_problem(setting().rays, setting().discs);
    const RunOptions one_by_one{.engine = Engine::plain};
    const Counts plain = search_octree(problem, {5}, {}, one_by_one).counts;
    Counts once = search_octree(problem, {5}, {.mailboxing = true}, one_by_one).counts;
    CHECK(once.disc_tests < plain.disc_tests);
    CHECK(once.disc_tests > plain.hits);
    once.disc_tests = plain.disc_tests;
    CHECK(once == plain);
    Counts anew = search_octree(problem, {5, Traversal::restart}, {}, one_by_one).counts;
    CHECK(anew.nodes > plain.nodes);
    // If a ray runs in a plane between leaves, top-down traversal enters the leaves on both sides, restart only on one.
    CHECK(anew.disc_tests <= plain.disc_tests);
    const Counts grid = search_grid(problem, {32}, {}, one_by_one).counts;
    Counts grid_once = search_grid(problem, {32}, {.mailboxing = true}, one_by_one).counts;
    CHECK(grid_once.disc_tests < grid.disc_tests);
    grid_once.disc_tests = grid.disc_tests;
    CHECK(grid_once == grid);
    CHECK(search_grid(problem, {32}, {.insertion = Insertion::bounding_box}).counts.references > grid.references);
  }

  TEST_CASE("front to back visits the same nodes as top-down; neighbour links visit the same leaves as restarts") {
    const Problem problem = make_problem(setting().rays, setting().discs);
    for (const int depth : {0, 2, 6}) {
      const auto counts = [&](Traversal traversal) { return search_octree(problem, {depth, traversal}, {}).counts; };
      CHECK(counts(Traversal::front_to_back) == counts(Traversal::top_down));
      const Counts anew = counts(Traversal::restart);
      Counts linked = counts(Traversal::neighbour_links);
      if (depth > 0) CHECK(linked.nodes < anew.nodes);
      linked.nodes = anew.nodes;
      CHECK(linked == anew);
    }
  }

  TEST_CASE("an index built for display has the nodes, references and placements of one that is searched") {
    const Problem problem = make_problem(setting().rays, setting().discs);
    for (const Insertion insertion : {Insertion::exact, Insertion::bounding_box}) {
      const IndexVariant variant{.insertion = insertion};
      std::size_t nodes = 0;
      std::size_t references = 0;
      const auto count = [&](const IndexNode& node) {
        ++nodes;
        references += node.references;
        CHECK((node.leaf || node.references == 0));
      };
      const IndexSize octree = inspect_octree(problem, {4}, variant, count);
      CHECK(octree.nodes == nodes);
      CHECK(octree.references == references);
      CHECK(octree.references == search_octree(problem, {4}, variant).counts.references);
      CHECK(octree.placements == search_octree(problem, {4}, variant).counts.placements);
      CHECK(octree.bytes == 12 * nodes + 4 * references);
      const IndexSize linked = inspect_octree(problem, {4, Traversal::neighbour_links}, variant, [](const auto&) {});
      CHECK(linked.nodes == octree.nodes);
      CHECK(linked.bytes > octree.bytes);
      nodes = references = 0;
      const IndexSize grid = inspect_grid(problem, {20}, variant, count);
      CHECK(grid.nodes == nodes);
      CHECK(grid.nodes == 8000);
      CHECK(grid.references == references);
      CHECK(grid.references == search_grid(problem, {20}, variant).counts.references);
      CHECK(grid.bytes == 8 * 8001 + 4 * references);
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("two discs in opposite corners: four levels with two nodes each; every other octant is left out") {
    const std::vector<Disc> corners{{.centre = glm::dvec3{-1}, .radius = 1e-3},
                                    {.centre = glm::dvec3{1}, .radius = 1e-3}};
    // From corner to corner, but not in the planes between cells.
    const glm::dvec3 direction = glm::normalize(glm::dvec3{1, 1 + 1e-4, 1 - 1e-4});
    const std::vector<Ray> rays{{.origin = glm::dvec3{0}, .direction = direction}};
    const Problem problem = make_problem(rays, corners);
    std::vector<int> by_level(4);
    (void)inspect_octree(problem, {3}, {}, [&](const IndexNode& node) { ++by_level[node.level]; });
    CHECK(by_level == std::vector<int>{1, 2, 2, 2});
    CHECK(search_octree(problem, {3}, {}).counts.nodes == 7);
    // The two leaves take 4 visits each. At each end, the ray crosses 1 to 3 empty octants of side 1/8 (3 visits each),
    // 1 to 3 of side 1/4 (2 visits each) and at most one of side 1/2 (1 visit).
    const std::uint64_t visits = search_octree(problem, {3, Traversal::restart}, {}).counts.nodes;
    CHECK(visits > 2 * 4 + 2 * (3 + 2));
    CHECK(visits <= 2 * 4 + 2 * 3 * (3 + 2) + 2);
  }

  TEST_CASE("a full octree is searched with 4 (k + 1) visits along four leaves in a row") {
    const auto discs = uniform_discs(Body::cube, 2, 3000, 0.2, 1);
    const std::vector<Ray> rays{{.origin = {0.1, 0.1, 0.1}, .direction = {1, 0, 0}}};
    const Problem problem = make_problem(rays, discs);
    CHECK(search_octree(problem, {2, Traversal::restart}, {}).counts.nodes == 4 * 3);
    CHECK(search_octree(problem, {2}, {}).counts.nodes == 1 + 2 + 4);
    // Visits 3 nodes down to the first leaf, then follows three links: all leaves have the same size.
    CHECK(search_octree(problem, {2, Traversal::neighbour_links}, {}).counts.nodes == 3 + 3);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("parameters out of range are refused") {
    const Problem problem = make_problem(setting().rays, setting().discs);
    CHECK_THROWS_AS((void)search_octree(problem, {-1}, {}), std::invalid_argument);
    CHECK_THROWS_AS((void)search_grid(problem, {0}, {}), std::invalid_argument);
    CHECK_THROWS_AS((void)inspect_octree(problem, {21}, {}, [](const IndexNode&) {}), std::invalid_argument);
    CHECK_THROWS_AS((void)inspect_grid(problem, {-5}, {}, [](const IndexNode&) {}), std::invalid_argument);
  }
}
