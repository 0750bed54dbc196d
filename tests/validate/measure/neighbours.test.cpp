#include "detp/validate/measure/neighbours.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace detp;
using namespace detp::validate;

namespace {

bool contains(const std::vector<Candidate>& all, const Candidate& wanted) {
  return std::find(all.begin(), all.end(), wanted) != all.end();
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("techniques left out of a ranking are the exact ones that are not in it") {
    const auto left_out = techniques_left_out({{Technique::grid, GridParameters{3}}, {}});
    CHECK(contains(left_out, {Technique::bsp, BspParameters{}}));
    CHECK(contains(left_out, {Technique::bvh, BvhParameters{}}));
    // all techniques except the two in the ranking and the two that are not exact
    CHECK(left_out.size() == all_techniques.size() - 4);
    for (const Candidate& candidate : left_out) CHECK(record_of(candidate.technique).exact);
  }

  TEST_CASE(
      "neighbours have half and twice the fan-out, leaves 4 times smaller and larger, and depths one level away") {
    const auto trees = neighbours({Technique::box_tree, BoxTreeParameters{4, 16}});
    CHECK(trees.size() == 4);
    for (const auto& tree : {BoxTreeParameters{2, 16}, {8, 16}, {4, 4}, {4, 64}})
      CHECK(contains(trees, {Technique::box_tree, tree}));
    const auto octrees = neighbours({Technique::octree, OctreeParameters{5}});
    CHECK(octrees.size() == 2);
    CHECK(contains(octrees, {Technique::octree, OctreeParameters{4}}));
    const auto grids = neighbours({Technique::grid, GridParameters{100}});
    CHECK(contains(grids, {Technique::grid, GridParameters{71}}));
    CHECK(contains(grids, {Technique::grid, GridParameters{140}}));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("neighbours stay within the parameters' ranges, also at their ends") {
    for (const Candidate& candidate :
         {Candidate{Technique::octree, OctreeParameters{0}}, Candidate{Technique::octree, OctreeParameters{20}},
          Candidate{Technique::cell_spheres, CellSpheresParameters{0}},
          Candidate{Technique::cell_spheres, CellSpheresParameters{16}}, Candidate{Technique::grid, GridParameters{1}},
          Candidate{Technique::grid, GridParameters{1 << 20}},
          Candidate{Technique::sphere_cache, SphereCacheParameters{0.999, 1}},
          Candidate{Technique::bsp, BspParameters{32, 1}}, Candidate{Technique::bsp, BspParameters{32, 1 << 20}},
          Candidate{Technique::bvh, BvhParameters{}}, Candidate{}})
      for (const Candidate& neighbour : neighbours(candidate)) {
        CHECK_NOTHROW(check(neighbour));
        CHECK_FALSE(neighbour == candidate);
      }
  }
}
