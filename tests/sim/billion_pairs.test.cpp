#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/candidates.hpp"
#include "support/hard_scene.hpp"
#include "support/machine.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using namespace detp::support;

namespace {

/// All exact techniques. Techniques that decide in floats occur with several parameters.
std::vector<Candidate> all_exact() {
  std::vector<Candidate> list = float_candidates();
  list.insert(list.end(), {{Technique::sphere_tree, SphereTreeParameters{8, 8}},
                           {Technique::sphere_cache, SphereCacheParameters{0.65, 8, SampleOrder::hilbert}},
                           {Technique::octree, OctreeParameters{4}},
                           {Technique::octree, OctreeParameters{4, Traversal::neighbour_links}},
                           {Technique::bsp, BspParameters{}},
                           {Technique::grid, GridParameters{16}},
                           {Technique::bvh, BvhParameters{}},
                           {Technique::ray_map, RayMapParameters{}}});
  return support::built(std::move(list));
}

/// Totals of the comparisons so far.
struct Tried {
  double pairs = 0;
  std::uint64_t hits = 0;
  std::uint64_t runs = 0;
  std::size_t different = 0;  ///< pairs that differ
  int other_sums = 0;         ///< runs whose irradiance differs in some byte

  void add(const Outcome& outcome, const Outcome& expected) {
    std::vector<Pair> others;
    std::set_symmetric_difference(outcome.pairs.begin(), outcome.pairs.end(), expected.pairs.begin(),
                                  expected.pairs.end(), std::back_inserter(others));
    different += others.size();
    add_without_pairs(outcome, expected);
  }

  void add_without_pairs(const Outcome& outcome, const Outcome& expected) {
    ++runs;
    other_sums += outcome.hits == expected.hits && outcome.irradiance == expected.irradiance ? 0 : 1;
  }
};

/// Compares the hits of all techniques with the canonical predicate's decision of every pair.
void compare(const HardScene& scene, bool front, Tried& tried) {
  const Problem problem = make_problem(scene.rays, scene.discs, front);
  const Outcome expected = truth_of(problem);
  tried.pairs += static_cast<double>(scene.rays.size()) * static_cast<double>(scene.discs.size());
  tried.hits += expected.total_hits;
  for (const Candidate& candidate : all_exact()) tried.add(run(problem, candidate, {.pairs = true}), expected);
  for (const Candidate& candidate : float_candidates()) tried.add_without_pairs(run(problem, candidate), expected);
}

void set_powers(std::vector<Ray>& rays) {
  RandomSequence random(600, rays.size());
  for (Ray& ray : rays) ray.power = std::pow(10, 10 * random.uniform());
}

/// Pairs of a family, or for the number after the last family, of rays through the corners of boxes.
Tried hard_pairs(std::size_t family) {
  Tried tried;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const bool corners = family == families.size();
    HardScene scene = corners ? scene_at_corners(i, 2000, 5000) : hard_scene(family, 1000 + i, 2000, 5000);
    if (i % 2 == 1) set_powers(scene.rays);
    compare(scene, i % 5 == 4, tried);
  }
  return tried;
}

/// Isotropic lines, half of them cut to segments; more rays than fit in one block.
Tried isotropic_pairs(Body body) {
  HardScene scene{uniform_discs(body, 2, 1500, 0.04, 5), {}};
  scene.rays = LineField(enclosing_sphere(scene.discs), 6).lines(0, 160'000);
  RandomSequence random(601, 0);
  for (std::size_t i = 0; i < scene.rays.size(); i += 2) scene.rays[i].length = random.magnitude(-2, 0.5);
  set_powers(scene.rays);
  Tried tried;
  compare(scene, false, tried);
  return tried;
}

void report(std::string_view what, const Tried& tried, double& pairs) {
  CAPTURE(what);
  CHECK(tried.different == 0);
  CHECK(tried.other_sums == 0);
  CHECK(tried.hits > 10'000);
  MESSAGE(fmt::format("{:12} {:.3g} pairs, {} hits, {} runs: {} pairs and {} sums differ", what, tried.pairs,
                      tried.hits, tried.runs, tried.different, tried.other_sums));
  pairs += tried.pairs;
}

}  // namespace

TEST_SUITE("statistical") {
  TEST_CASE("a billion pairs: every exact technique finds the predicate's hits, with the same sums to the last bit") {
    const auto tried = in_parallel(families.size() + 3, [](std::size_t i) {
      if (i <= families.size()) return hard_pairs(i);
      return isotropic_pairs(i == families.size() + 1 ? Body::cube : Body::cube_faces);
    });
    std::vector<std::string_view> kinds;
    for (const Family& family : families) kinds.push_back(family.name);
    kinds.insert(kinds.end(), {"corners", "volume", "surface"});
    double pairs = 0;
    for (std::size_t i = 0; i < kinds.size(); ++i) report(kinds[i], tried[i], pairs);
    MESSAGE(fmt::format("{:.4g} pairs in all", pairs));
    CHECK(pairs >= 1e9);
  }
}
