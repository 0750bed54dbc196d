#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <span>
#include <vector>

#include "detp/sim/technique/technique.hpp"
#include "support/candidates.hpp"
#include "support/hard_scene.hpp"
#include "support/machine.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using namespace detp::support;

namespace {

const std::vector<Candidate>& hard_candidates() {
  static const std::vector<Candidate> list = [] {
    std::vector<Candidate> all = float_candidates();
    all.insert(all.end(), {{Technique::sphere_cache, SphereCacheParameters{0.65, 8, SampleOrder::hilbert}},
                           {Technique::sphere_tree, SphereTreeParameters{2, 1}},
                           {Technique::sphere_tree, SphereTreeParameters{8, 4}},
                           {Technique::octree, OctreeParameters{3}},
                           {Technique::octree, OctreeParameters{5}},
                           {Technique::octree, OctreeParameters{5, Traversal::front_to_back}},
                           {Technique::octree, OctreeParameters{3, Traversal::restart}},
                           {Technique::octree, OctreeParameters{3, Traversal::neighbour_links}},
                           {Technique::octree, OctreeParameters{5, Traversal::neighbour_links}},
                           {Technique::grid, GridParameters{8}},
                           {Technique::grid, GridParameters{27}},
                           {Technique::bsp, BspParameters{6, 1}},
                           {Technique::bsp, BspParameters{18, 1}},
                           {Technique::bvh, BvhParameters{BuildQuality::low}},
                           {Technique::bvh, BvhParameters{BuildQuality::medium}},
                           {Technique::ray_map, RayMapParameters{1}},
                           {Technique::ray_map, RayMapParameters{32}}});
    return support::built(std::move(all));
  }();
  return list;
}

/// The engines of a technique.
std::span<const Engine> engines_of(const Candidate& candidate) {
  static constexpr std::array both{Engine::simd, Engine::plain};
  return std::span(both).first(record_of(candidate.technique).simd ? 2 : 1);
}

/// Number of pairs that only the technique finds, plus those that only the canonical predicate finds.
std::size_t differences(const Outcome& outcome, const Outcome& expected) {
  std::vector<Pair> different;
  std::set_symmetric_difference(expected.pairs.begin(), expected.pairs.end(), outcome.pairs.begin(),
                                outcome.pairs.end(), std::back_inserter(different));
  return different.size();
}

struct FamilyHits {
  std::uint64_t hits = 0;
  std::size_t different = 0;  ///< pairs that only the canonical predicate or only a technique finds
};

/// `scenes` scenes of a family; each ray is hard for one disc.
FamilyHits search_family(std::size_t family, std::uint64_t scenes, std::size_t discs, std::size_t rays) {
  FamilyHits found;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    const HardScene scene = hard_scene(family, i, discs, rays);
    const Problem problem = make_problem(scene.rays, scene.discs);
    const Outcome expected = truth_of(problem);
    found.hits += expected.total_hits;
    for (const Candidate& candidate : hard_candidates())
      for (const Engine engine : engines_of(candidate)) {
        const Outcome outcome = run(problem, candidate, {.pairs = true, .engine = engine});
        const std::size_t different = differences(outcome, expected);
        INFO(families[family].name, ", scene ", i, ", ", name(candidate.technique), ", ", name(engine));
        CHECK(different == 0);
        found.different += different;
      }
  }
  return found;
}

void check_all_agree(std::uint64_t scenes, std::size_t discs, std::size_t rays, bool print) {
  const auto found =
      in_parallel(families.size(), [&](std::size_t family) { return search_family(family, scenes, discs, rays); });
  for (std::size_t family = 0; family < families.size(); ++family) {
    CHECK(found[family].hits > scenes * rays / 10);
    if (print)
      MESSAGE(fmt::format("{:12} {:8} hard rays {:8} hits {} differences", families[family].name, scenes * rays,
                          found[family].hits, found[family].different));
  }
}

/// Discs that touch the faces x = ±1 of their common box, and rays almost along these faces. The rays pass the points
/// of contact within rounding error, some inside the box and some outside.
HardScene scene_at_faces(std::uint64_t index) {
  RandomSequence random(300, index);
  HardScene scene;
  for (const double side : {-0.875, 0.875}) {
    scene.discs.push_back({glm::dvec3{side}, {0, 0, 1}, 0.125});
    for (int i = 0; i < 4; ++i) {
      const double angle = random.between(0, 2 * std::numbers::pi);
      scene.discs.push_back({{side, random.between(-0.8, 0.8), random.between(-0.8, 0.8)},
                             glm::normalize(glm::dvec3{0, std::cos(angle), std::sin(angle)}),
                             0.125});
    }
  }
  for (std::size_t i = 0; i < 300; ++i) {
    const Disc& disc = scene.discs[i % 10];
    const double out = disc.centre.x > 0 ? 1 : -1;
    const double cosine = random.magnitude(-10, -3);
    glm::dvec3 direction = cosine * disc.normal + random.sign() * glm::cross(disc.normal, glm::dvec3{1, 0, 0});
    direction.x = random.one_in(4) ? 0 : out * random.magnitude(-17, -5);
    direction = glm::normalize(direction);
    const glm::dvec3 touch = disc.centre + glm::dvec3{out * disc.radius * (1 + random.rounding_offset()), 0, 0};
    scene.rays.push_back({.origin = touch - random.between(0.3, 2) * direction, .direction = direction});
  }
  return scene;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("no cull loses a hard ray: all exact techniques find the predicate's hits") {
    check_all_agree(4, 20, 500, false);  // the first of the 200 scenes below
  }

  TEST_CASE("rays along the outer faces of the index, or just outside them, hit the discs that touch these faces") {
    std::uint64_t hits = 0;
    for (std::uint64_t i = 0; i < 30; ++i) {
      const HardScene scene = scene_at_faces(i);
      const Problem problem = make_problem(scene.rays, scene.discs);
      const Outcome expected = truth_of(problem);
      hits += expected.total_hits;
      for (const Candidate& candidate : hard_candidates())
        for (const Engine engine : engines_of(candidate))
          CHECK(differences(run(problem, candidate, {.pairs = true, .engine = engine}), expected) == 0);
    }
    CHECK(hits > 3000);
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("a million hard rays: all exact techniques find the predicate's hits") {
    check_all_agree(200, 20, 500, true);
  }
}
