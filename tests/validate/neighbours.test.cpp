#include "detp/validate/neighbours.hpp"

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
  TEST_CASE("what is left out of a ranking are the exact techniques that are not in it") {
    const auto left_out = techniques_left_out({{Technique::grid, GridParameters{3}}, {}});
    CHECK(contains(left_out, {Technique::bsp, BspParameters{}}));
    CHECK(contains(left_out, {Technique::bvh, BvhParameters{}}));
    CHECK(left_out.size() == all_techniques.size() - 4);  // but for the two given and the two that are not exact
    for (const Candidate& candidate : left_out) CHECK(finds_all_hits(candidate.technique));
  }

  TEST_CASE("trees of boxes try 4 and 8 children and leaves of 8, 16, 64; depths one level; grids 0.7 and 1.4 times") {
    const auto trees = neighbours({Technique::sphere_tree, SphereTreeParameters{4, 16, Bounds::boxes}});
    CHECK(trees.size() == 5);
    CHECK(contains(trees, {Technique::sphere_tree, SphereTreeParameters{8, 64, Bounds::boxes}}));
    const auto octrees = neighbours({Technique::octree, OctreeParameters{5}});
    CHECK(octrees.size() == 2);
    CHECK(contains(octrees, {Technique::octree, OctreeParameters{4}}));
    const auto grids = neighbours({Technique::grid, GridParameters{100}});
    CHECK(contains(grids, {Technique::grid, GridParameters{70}}));
    CHECK(contains(grids, {Technique::grid, GridParameters{140}}));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("neighbours stay within the parameters' ranges, at the ends too") {
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
