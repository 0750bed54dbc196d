#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <vector>

#include "detp/sim/technique/technique.hpp"
#include "support/hard_geometry.hpp"

using namespace detp;
using namespace detp::sim;
using namespace detp::support;

namespace {

/// Discs that touch, just, the planes between cells, and rays that just hit or miss them.
struct HardScene {
  std::vector<Disc> discs;
  std::vector<Ray> rays;
};

/// Two discs of radius 1/8 fix the scene's box to `centre` ± 1, so that halves of halves are planes between cells. The
/// others have their centre, or a point of their rim, within rounding of one, two or three such planes.
Disc disc_at_cells(Dice& dice, const glm::dvec3& centre, double scale) {
  const auto on_plane = [&](double x) { return std::floor(8 * x) / 4 - 1 + dice.whisker() * 1e2; };
  Disc disc;
  disc.radius = scale * std::min(0.125, dice.magnitude(-4, 0));
  disc.normal = dice.normal();
  glm::dvec3 place{dice.between(-0.9, 0.9), dice.between(-0.9, 0.9), dice.between(-0.9, 0.9)};
  for (int axis = 0; axis < 3; ++axis)
    if (dice.one_in(1.5)) place[axis] = on_plane(dice.between(0.1, 0.9));
  disc.centre = centre + scale * place;
  if (dice.one_in(2)) {
    const auto [u, v] = basis_around(disc.normal);
    const double angle = dice.between(0, 2 * std::numbers::pi);
    disc.centre -= disc.radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
  return disc;
}

HardScene hard_scene(std::size_t family_number, std::uint64_t index, std::size_t discs, std::size_t rays) {
  const Family& family = families[family_number];
  Dice dice(200 + family_number, index);
  const glm::dvec3 centre = family.scale * family.offset * glm::dvec3{1, -0.25, 0.5};
  HardScene scene;
  for (const double side : {-0.875, 0.875})
    scene.discs.push_back({centre + family.scale * side, dice.normal(), family.scale / 8});
  while (scene.discs.size() < discs) scene.discs.push_back(disc_at_cells(dice, centre, family.scale));
  for (std::size_t i = 0; i < rays; ++i) scene.rays.push_back(hard_ray(family, dice, scene.discs[i % discs]));
  return scene;
}

const Candidate brute{Technique::brute_force, BruteForceParameters{}};

const std::vector<Candidate>& culling_candidates() {
  static const std::vector<Candidate> list{
      {Technique::sphere_cache, SphereCacheParameters{0.65, 8}},
      {Technique::sphere_cache, SphereCacheParameters{0.9, 1000}},
      {Technique::sphere_cache, SphereCacheParameters{0.65, 8, SampleOrder::hilbert}},
      {Technique::cell_spheres, CellSpheresParameters{2}},
      {Technique::cell_spheres, CellSpheresParameters{6}},
      {Technique::sphere_tree, SphereTreeParameters{2, 1}},
      {Technique::sphere_tree, SphereTreeParameters{8, 8, Bounds::boxes}},
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
      {Technique::bvh, BvhParameters{BuildQuality::medium}}};
  return list;
}

/// Pairs that one technique finds and brute force does not, or the other way round.
std::size_t differences(const Outcome& outcome, const Outcome& expected) {
  std::vector<Pair> different;
  std::set_symmetric_difference(expected.pairs.begin(), expected.pairs.end(), outcome.pairs.begin(),
                                outcome.pairs.end(), std::back_inserter(different));
  return different.size();
}

/// Runs `scenes` of every family, each ray hard for one disc.
void check_all_agree(std::uint64_t scenes, std::size_t discs, std::size_t rays, bool told) {
  for (std::size_t family = 0; family < families.size(); ++family) {
    std::uint64_t hits = 0;
    std::size_t all_different = 0;
    for (std::uint64_t i = 0; i < scenes; ++i) {
      const HardScene scene = hard_scene(family, i, discs, rays);
      const Problem problem = make_problem(scene.rays, scene.discs);
      const Outcome expected = run(problem, brute, {.pairs = true});
      hits += expected.total_hits;
      for (const Candidate& candidate : culling_candidates()) {
        const std::size_t different = differences(run(problem, candidate, {.pairs = true}), expected);
        INFO(families[family].name, ", scene ", i, ", ", name(candidate.technique));
        CHECK(different == 0);
        all_different += different;
      }
    }
    CHECK(hits > scenes * rays / 10);
    if (told)
      MESSAGE(fmt::format("{:12} {:8} hard rays {:8} hits {} differences", families[family].name, scenes * rays, hits,
                          all_different));
  }
}

/// Discs that touch the faces x = ±1 of their common box, and rays that touch the discs there, some from outside.
HardScene scene_at_faces(std::uint64_t index) {
  Dice dice(300, index);
  HardScene scene;
  for (const double side : {-0.875, 0.875}) {
    scene.discs.push_back({glm::dvec3{side}, {0, 0, 1}, 0.125});
    for (int i = 0; i < 4; ++i) {
      const double angle = dice.between(0, 2 * std::numbers::pi);
      scene.discs.push_back({{side, dice.between(-0.8, 0.8), dice.between(-0.8, 0.8)},
                             glm::normalize(glm::dvec3{0, std::cos(angle), std::sin(angle)}),
                             0.125});
    }
  }
  for (std::size_t i = 0; i < 300; ++i) {
    const Disc& disc = scene.discs[i % 10];
    const double out = disc.centre.x > 0 ? 1 : -1;
    const double cosine = dice.magnitude(-10, -3);
    glm::dvec3 direction = cosine * disc.normal + dice.sign() * glm::cross(disc.normal, glm::dvec3{1, 0, 0});
    direction.x = dice.one_in(4) ? 0 : out * dice.magnitude(-17, -5);
    direction = glm::normalize(direction);
    const glm::dvec3 touch = disc.centre + glm::dvec3{out * disc.radius * (1 + dice.whisker()), 0, 0};
    scene.rays.push_back({.origin = touch - dice.between(0.3, 2) * direction, .direction = direction});
  }
  return scene;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("no cull loses a hard ray: all exact techniques find brute force's hits") {
    check_all_agree(12, 20, 500, false);
  }

  TEST_CASE("rays along the outer faces of the index, or just outside them, hit the discs that touch these") {
    std::uint64_t hits = 0;
    for (std::uint64_t i = 0; i < 30; ++i) {
      const HardScene scene = scene_at_faces(i);
      const Problem problem = make_problem(scene.rays, scene.discs);
      const Outcome expected = run(problem, brute, {.pairs = true});
      hits += expected.total_hits;
      for (const Candidate& candidate : culling_candidates())
        CHECK(differences(run(problem, candidate, {.pairs = true}), expected) == 0);
    }
    CHECK(hits > 3000);
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("a million hard rays: all exact techniques find brute force's hits") {
    check_all_agree(200, 20, 500, true);
  }
}
