#include "detp/sim/effects/sampled_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "detp/sim/geometry/curve.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/search/problem.hpp"

using namespace detp::sim;

TEST_SUITE("known answer") {
  TEST_CASE("sampled discs follow the curve of lebesgue_code, but for rounding at the borders of cells") {
    const auto discs = uniform_discs(Body::cube, 2, 8000, 0.01, 1);
    const CurveSample sample = curve_sample(discs, enclosing_sphere(discs));
    REQUIRE(sample.discs.size() == discs.size());
    Box box;
    for (const Disc& disc : discs) box.include(disc.centre);
    std::set<std::uint32_t> numbers;
    std::size_t other_cells = 0;
    double farthest = 0;
    double steepest = 0;
    for (std::size_t i = 0; i < sample.discs.size(); ++i) {
      const Disc& disc = discs[sample.discs[i].number];
      numbers.insert(sample.discs[i].number);
      other_cells += sample.keys[i] == lebesgue_code(disc.centre, box) ? 0 : 1;
      const glm::dvec3 centre = glm::dvec3(sample.discs[i].centre) * sample.unit + sample.origin;
      farthest = std::max(farthest, glm::length(centre - disc.centre));
      steepest = std::max(steepest, std::abs(sample.discs[i].steepness.x - std::abs(disc.normal.x)));
    }
    CHECK(farthest < 1e-6);
    CHECK(steepest < 1e-6);
    CHECK(numbers.size() == discs.size());
    CHECK(other_cells < discs.size() / 20);
    CHECK(std::is_sorted(sample.keys.begin(), sample.keys.end()));
  }

  TEST_CASE("a node is split where the curve leaves a cell, and its box holds its discs") {
    const auto discs = uniform_discs(Body::cube_faces, 2, 5000, 0.01, 1);
    const CurveSample sample = curve_sample(discs, enclosing_sphere(discs));
    const auto nodes = sampled_tree(sample);
    REQUIRE(nodes.front().size() == sample.discs.size());
    CHECK(nodes.front().next == nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const SampledNode& node = nodes[i];
      bool holds = true;
      for (std::uint32_t j = node.first; j < node.end; ++j) {
        const SampledDisc& disc = sample.discs[j];
        for (int axis = 0; axis < 3; ++axis)
          holds = holds && node.low[axis] <= disc.centre[axis] && node.high[axis] >= disc.centre[axis] &&
                  node.flattest[axis] <= disc.steepness[axis];
      }
      CHECK(holds);
      if (node.size() < least_split) {
        CHECK(node.next == i + 1);
        continue;
      }
      const SampledNode& a = nodes[i + 1];
      const SampledNode& b = nodes[a.next];
      CHECK(a.first == node.first);
      CHECK(a.end == b.first);
      CHECK(b.end == node.end);
      CHECK(b.next == node.next);
      // the first bit in which the keys of the node differ is 0 in the one part and 1 in the other
      const std::uint64_t differ = sample.keys[node.first] ^ sample.keys[node.end - 1];
      if (differ == 0) continue;
      const std::uint64_t bit = std::bit_floor(differ);
      CHECK((sample.keys[a.end - 1] & bit) == 0);
      CHECK((sample.keys[b.first] & bit) != 0);
    }
  }
}
