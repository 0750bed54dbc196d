#include "detp/sim/index/bsp_nodes.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/index/disc_index.hpp"
#include "detp/sim/open/uniform_discs.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const std::vector<Ray> one_ray{{}};

int deepest(const Problem& problem, const BspParameters& parameters) {
  int level = 0;
  (void)inspect_bsp(problem, parameters, [&](const IndexNode& node) { level = std::max(level, node.level); });
  return level;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("every leaf lists the discs that overlap it, and leaves fill the box") {
    auto discs = uniform_discs(Body::cube, 2, 600, 0.05, 5);
    for (std::size_t i = 0; i < discs.size(); i += 7) discs[i].radius = 0.4;
    const Problem problem = make_problem(one_ray, discs);
    const BspParameters parameters{12, 2};
    const BspNodes tree = build_bsp(problem, parameters, {});
    double volume = 0;
    std::size_t references = 0;
    std::size_t nodes = 0;
    std::size_t next = 0;  // references are in the order of the leaves
    const IndexSize size = inspect_bsp(problem, parameters, [&](const IndexNode& node) {
      ++nodes;
      if (!node.leaf) return;
      const glm::dvec3 sides = node.box.size();
      volume += sides.x * sides.y * sides.z;
      references += node.references;
      for (std::uint32_t i = 0; i < discs.size(); ++i) {
        const bool listed =
            next < tree.references.size() && node.references > 0 && tree.references[next] == i && next < references;
        REQUIRE(listed == overlaps(discs[i], node.box, problem.slack()));
        if (listed) ++next;
      }
    });
    const glm::dvec3 sides = tree.box.size();
    CHECK(volume == doctest::Approx(sides.x * sides.y * sides.z).epsilon(1e-12));
    CHECK(size.nodes == nodes);
    CHECK(size.nodes > 100);
    CHECK(size.references == references);
    CHECK(tree.references.size() == references);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("two distant clusters: one plane between them, across the longest side, and no disc in both") {
    std::vector<Disc> discs;
    for (int i = 0; i < 100; ++i) discs.push_back({{i < 50 ? 0 : 10, 0, 0}, {0, 0, 1}, 1});
    const Problem problem = make_problem(one_ray, discs);
    const BspNodes tree = build_bsp(problem, {1, 1}, {});
    REQUIRE(tree.nodes.size() == 3);
    CHECK(tree.nodes[0].axis == 0);
    CHECK(tree.nodes[0].plane == doctest::Approx(5));
    CHECK(tree.nodes[1].count == 50);
    CHECK(tree.nodes[2].count == 50);
    CHECK(tree.placements == 100);
  }

  TEST_CASE("depth and leaf size stay within their limits") {
    const auto discs = uniform_discs(Body::cube, 2, 2000, 0.01, 5);
    const Problem problem = make_problem(one_ray, discs);
    CHECK(deepest(problem, {0, 1}) == 0);
    CHECK(deepest(problem, {4, 1}) == 4);
    CHECK(deepest(problem, {64, 2000}) == 0);
    CHECK(deepest(problem, {64, 1100}) == 1);
    CHECK(deepest(problem, {64, 1}) > 12);
  }

  TEST_CASE("splitting ends at coincident discs: a thousand need no more memory than copies in a few leaves") {
    const std::vector<Disc> discs(1000, Disc{});
    const Problem problem = make_problem(one_ray, discs);
    CHECK(build_bsp(problem, {64, 1}, {}).references.size() == 1000);
  }

  TEST_CASE("after a stop request it builds nothing") {
    const auto discs = uniform_discs(Body::cube, 2, 2000, 0.01, 5);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_WITH_AS((void)build_bsp(make_problem(one_ray, discs), {}, source.get_token()),
                         "stopped while building the BSP tree", Stopped);
  }
}
