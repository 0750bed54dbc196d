#include "detp/sim/index/bsp_nodes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <numbers>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/disc_box.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/index/disc_index.hpp"
#include "detp/sim/index/octree_nodes.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const std::vector<Ray> one_ray{{}};

int deepest(const Problem& problem, const BspParameters& parameters) {
  int level = 0;
  (void)inspect_bsp(problem, parameters, [&](const IndexNode& node) { level = std::max(level, node.level); });
  return level;
}

std::vector<Box> boxes_of(const std::vector<LinkedNode>& nodes, const Box& cube) {
  std::vector<Box> boxes(nodes.size());
  boxes[0] = cube;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].inner)
      for (unsigned octant = 0; octant < 8; ++octant) boxes[nodes[i].first + octant] = octant_of(boxes[i], octant);
  return boxes;
}

/// Whether box b adjoins that face of box a from outside, and covers the whole face.
bool covers(const Box& b, const Box& a, int face) {
  const int axis = face / 2;
  if (face % 2 == 0 ? b.high[axis] != a.low[axis] : b.low[axis] != a.high[axis]) return false;
  for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
    if (b.low[other] > a.low[other] || b.high[other] < a.high[other]) return false;
  return true;
}

const Candidate brute{Technique::brute_force, BruteForceParameters{}};
const Candidate bvh = default_candidate(has_embree ? Technique::bvh : Technique::bsp);

/// Rays aimed near the discs from the distance `far`: alternately segments that end near a disc, and lines.
std::vector<Ray> rays_from(const std::vector<Disc>& discs, double far) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < 4 * discs.size(); ++i) {
    const auto random = uniform4(31, Stream::tests, i);
    const Disc& disc = discs[i % discs.size()];
    const glm::dvec3 direction = uniform_direction(random[0], random[1]);
    const glm::dvec3 aside = glm::cross(direction, disc.normal);
    const glm::dvec3 aim = disc.centre + 1.5 * random[2] * disc.radius * aside;
    const double length = std::abs(far + (2 * random[3] - 1) * disc.radius);
    rays.push_back({.origin = aim - far * direction, .direction = direction});
    if (i % 2 == 0) rays.back().length = length;
  }
  return rays;
}

std::uint64_t check_agrees(const std::vector<Disc>& discs, double far) {
  const auto rays = rays_from(discs, far);
  const Problem problem = make_problem(rays, discs);
  const Outcome expected = run(problem, brute, {.pairs = true, .engine = Engine::plain});
  CHECK(run(problem, bvh, {.pairs = true}).pairs == expected.pairs);
  return expected.total_hits;
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

  TEST_CASE("every link leads to the node of the same size behind the face, or to the larger leaf there") {
    const auto discs = uniform_discs(Body::cube_faces, 2, 300, 0.02, 9);
    const std::vector<Ray> rays{{}};
    const OctreeNodes tree = build_octree(make_problem(rays, discs), 5, Insertion::exact, {});
    const std::vector<LinkedNode> nodes = link_neighbours(tree, {});
    const std::vector<Box> boxes = boxes_of(nodes, tree.cube);
    std::size_t larger = 0;
    std::size_t references = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!nodes[i].inner) references += nodes[i].count;
      for (int face = 0; face < 6; ++face) {
        const std::uint32_t link = nodes[i].links[static_cast<std::size_t>(face)];
        const int axis = face / 2;
        const bool outer =
            face % 2 == 0 ? boxes[i].low[axis] == tree.cube.low[axis] : boxes[i].high[axis] == tree.cube.high[axis];
        REQUIRE((link == no_node) == outer);
        if (outer) continue;
        REQUIRE(covers(boxes[link], boxes[i], face));
        REQUIRE(nodes[link].level <= nodes[i].level);
        if (nodes[link].level == nodes[i].level) continue;
        REQUIRE_FALSE(nodes[link].inner);
        ++larger;
      }
    }
    CHECK(larger > 100);
    CHECK(references == tree.references.size());
  }

  TEST_CASE("a root without children is a leaf without links") {
    const std::vector<Disc> discs{{}};
    const std::vector<Ray> rays{{}};
    const std::vector<LinkedNode> nodes =
        link_neighbours(build_octree(make_problem(rays, discs), 0, Insertion::exact, {}), {});
    REQUIRE(nodes.size() == 1);
    CHECK_FALSE(nodes[0].inner);
    CHECK(nodes[0].count == 1);
    for (const std::uint32_t link : nodes[0].links) CHECK(link == no_node);
  }

  TEST_CASE("single precision loses no hit, at any size of the scene and any distance of the rays") {
    for (const double size : {1e-90, 1e-9, 1.0, 1e9, 1e75})
      for (const double far : {1e-3, 1.0, 1e6, 1e9, 1e13}) {
        INFO("size ", size, ", far ", far);
        auto discs = uniform_discs(Body::cube, 2, 100, 0.1, 5);
        for (Disc& disc : discs) disc.centre *= size, disc.radius *= size;
        CHECK(check_agrees(discs, far * size) > (far > 1e12 ? 10 : 150));
      }
  }

  TEST_CASE("… and discs far smaller than its rounding error are found beside large ones") {
    auto discs = uniform_discs(Body::cube, 2, 150, 0.1, 5);
    for (std::size_t i = 0; i < discs.size(); i += 2) discs[i].radius = 1e-9;
    CHECK(check_agrees(discs, 1) > 150);
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

  TEST_CASE("a test is a disc whose box the ray meets, a reference is a disc" * doctest::skip(!has_embree)) {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 1}, {{10, 0, 0}, {0, 0, 1}, 1}};
    const std::vector<Ray> rays{{.origin = {0, 0, -3}},
                                {.origin = {10.95, 0.95, 0}},  // in the corner of the box, next to the disc
                                {.origin = {0, 1.01, 0}},
                                {.origin = {0, 0, 5}, .length = 4.99}};
    const Outcome outcome = run(make_problem(rays, discs), {Technique::bvh, BvhParameters{BuildQuality::medium}});
    CHECK(outcome.counts ==
          Counts<std::uint64_t>{
              .loaded = 4, .segments = 4, .disc_tests = 2, .references = 2, .placements = 2, .hits = 1});
  }

  TEST_CASE("isotropic lines: the number of tests follows from the areas of the boxes" * doctest::skip(!has_embree)) {
    const auto discs = uniform_discs(Body::cube, 2, 2000, 0.05, 5);
    const auto rays = LineField(enclosing_sphere(discs), 6).lines(0, 20'000);
    // The number of lines that hit a convex body is proportional to its surface area. For a disc of radius d it is
    // 2π d², and for the disc's box
    //
    //     8 d² Σ √((1 - a²)(1 - b²))
    //
    // where the sum is over the pairs a, b of the normal's coordinates.
    double discs_area = 0;
    double boxes_area = 0;
    for (const auto& [centre, n, d] : discs) {
      const glm::dvec3 half = d * glm::sqrt(glm::dvec3{1.0} - n * n);
      boxes_area += 8 * (half.x * half.y + half.y * half.z + half.z * half.x);
      discs_area += 2 * std::numbers::pi * d * d;
    }
    const auto counts = run(make_problem(rays, discs), bvh).counts;
    CHECK(counts.hits > 10'000);
    const double counted = static_cast<double>(counts.disc_tests) / static_cast<double>(counts.hits);
    CHECK(counted == doctest::Approx(boxes_area / discs_area).epsilon(0.03));
  }
}
