#include "detp/sim/lists/sphere_nodes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>

#include "detp/sim/open/uniform_discs.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

std::vector<std::uint32_t> as_given(const std::vector<Disc>& discs) {
  std::vector<std::uint32_t> order(discs.size());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

/// How far a sphere extends outside another; negative if it lies inside.
double out_of(const Sphere& inner, const Sphere& outer) {
  return glm::distance(inner.centre, outer.centre) + inner.radius - outer.radius;
}

/// The largest distance by which a child extends outside its parent, or a disc outside its leaf.
double worst_nesting(const SphereTree& tree, const std::vector<Disc>& discs, const SphereTreeParameters& parameters) {
  double worst = -1;
  for (std::size_t i = 0; i < discs.size(); ++i)
    worst = std::max(worst, out_of({discs[i].centre, discs[i].radius},
                                   tree.levels[0][i / static_cast<std::size_t>(parameters.leaf)]));
  for (std::size_t level = 1; level < tree.levels.size(); ++level)
    for (std::size_t i = 0; i < tree.levels[level - 1].size(); ++i)
      worst = std::max(worst, out_of(tree.levels[level - 1][i],
                                     tree.levels[level][i / static_cast<std::size_t>(parameters.fan_out)]));
  return worst;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each sphere lies in its parent's, and each disc in its leaf's, within rounding") {
    for (const Body body : {Body::cube, Body::cube_faces})
      for (const SphereTreeParameters& parameters :
           {SphereTreeParameters{2, 1}, SphereTreeParameters{8, 12}, SphereTreeParameters{3, 5}}) {
        auto discs = uniform_discs(body, 2, 3001, 0.01, 4);
        for (std::size_t i = 0; i < discs.size(); ++i) discs[i].radius *= 1 + static_cast<double>(i % 7);
        CHECK(worst_nesting(make_sphere_tree(discs, as_given(discs), parameters), discs, parameters) < 1e-14);
      }
  }

  TEST_CASE("levels have as many nodes as needed, the top level one") {
    const auto discs = uniform_discs(Body::cube, 2, 1000, 0.01, 4);
    const SphereTree tree = make_sphere_tree(discs, as_given(discs), {4, 7});
    CHECK(tree.levels.size() == 5);
    CHECK(tree.levels[0].size() == 143);
    CHECK(tree.levels[1].size() == 36);
    CHECK(tree.levels[4].size() == 1);
    CHECK(tree.nodes() == 143 + 36 + 9 + 3 + 1);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("one disc is its own sphere; two have the sphere that touches both; equal discs add nothing") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}, {{6, 0, 0}, {0, 0, 1}, 1}};
    const SphereTree alone = make_sphere_tree(std::span(discs).first(1), std::vector<std::uint32_t>{0}, {2, 1});
    CHECK(alone.levels.size() == 1);
    CHECK(alone.levels[0][0].radius == 1);
    const SphereTree both = make_sphere_tree(discs, std::vector<std::uint32_t>{0, 1}, {2, 1});
    CHECK(both.levels[1][0].centre == glm::dvec3{3, 0, 0});
    CHECK(both.levels[1][0].radius == 4);
    const std::vector<Disc> same(50, discs[1]);
    CHECK(make_sphere_tree(same, as_given(same), {3, 2}).levels.back()[0].radius == 1);
  }

  TEST_CASE("the sphere of a cube's corners is the cube's circumscribed sphere") {
    std::vector<Disc> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({{2 * (i & 1) - 1, (i & 2) - 1, (i & 4) / 2 - 1}, {0, 0, 1}, 0.25});
    const SphereTree tree = make_sphere_tree(corners, as_given(corners), {2, 8});
    CHECK(tree.levels.back()[0].radius == doctest::Approx(std::sqrt(3.0) + 0.25).epsilon(1e-15));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no disc, or parameters out of range, are refused") {
    const std::vector<Disc> discs{{}};
    CHECK_THROWS_WITH_AS((void)make_sphere_tree({}, {}, {2, 1}), doctest::Contains("discs"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)make_sphere_tree(discs, as_given(discs), {1, 1}), doctest::Contains("fan-out"),
                         std::invalid_argument);
  }
}
