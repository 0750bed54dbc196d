#include "detp/sim/technique/technique.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "support/candidates.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using namespace detp::sim;
using support::truth_of;

namespace {

const std::vector<Candidate>& tried_candidates() {
  static const std::vector<Candidate> list =
      support::built({{Technique::brute_force, BruteForceParameters{}},
                      {Technique::sphere_cache, SphereCacheParameters{0.65, 8}},
                      {Technique::sphere_cache, SphereCacheParameters{0.3, 3}},
                      {Technique::sphere_cache, SphereCacheParameters{0.9, 1'000'000'000}},
                      {Technique::sphere_cache, SphereCacheParameters{0.5, 5, SampleOrder::none}},
                      {Technique::sphere_cache, SphereCacheParameters{0.65, 8, SampleOrder::hilbert}},
                      {Technique::sphere_cache, SphereCacheParameters{1e-9, 1}},
                      {Technique::sphere_cache, SphereCacheParameters{0.65, 0}},
                      {Technique::sphere_cache, SphereCacheParameters{0.65, 0, SampleOrder::none}},
                      {Technique::cell_spheres, CellSpheresParameters{0}},
                      {Technique::cell_spheres, CellSpheresParameters{4}},
                      {Technique::cell_spheres, CellSpheresParameters{16}},
                      {Technique::sphere_tree, SphereTreeParameters{8, 4}},
                      {Technique::sphere_tree, SphereTreeParameters{2, 1}},
                      {Technique::box_tree, BoxTreeParameters{8, 8}},
                      {Technique::box_tree, BoxTreeParameters{2, 1}},
                      {Technique::box_tree, BoxTreeParameters{3, 1'000'000}},
                      {Technique::sphere_tree, SphereTreeParameters{7, 1'000'000}},
                      {Technique::octree, OctreeParameters{0}},
                      {Technique::octree, OctreeParameters{3}},
                      {Technique::octree, OctreeParameters{6}},
                      {Technique::octree, OctreeParameters{5, Traversal::front_to_back}},
                      {Technique::octree, OctreeParameters{5, Traversal::restart}},
                      {Technique::octree, OctreeParameters{5, Traversal::neighbour_links}},
                      {Technique::grid, GridParameters{1}},
                      {Technique::grid, GridParameters{7}},
                      {Technique::grid, GridParameters{50}},
                      {Technique::bsp, BspParameters{}},
                      {Technique::bsp, BspParameters{0, 1}},
                      {Technique::bsp, BspParameters{12, 8}},
                      {Technique::bsp, BspParameters{64, 1}},
                      {Technique::bvh, BvhParameters{BuildQuality::low}},
                      {Technique::bvh, BvhParameters{BuildQuality::medium}}});
  return list;
}

const Candidate brute{Technique::brute_force, BruteForceParameters{}};

/// Lines and segments with different powers, some parallel to an axis or to a coordinate plane.
std::vector<Ray> mixed_rays(std::size_t count, double side, std::uint64_t seed) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const auto a = uniform4(seed, Stream::tests, i);
    const auto b = uniform4(seed, Stream::tests, i, 1);
    Ray ray{.origin = side * glm::dvec3{a[0] - 0.5, a[1] - 0.5, a[2] - 0.5},
            .direction = uniform_direction(b[0], b[1]),
            .power = a[3]};
    if (i % 5 == 0) ray.direction = glm::dvec3{i % 3 == 0, i % 3 == 1, i % 3 == 2};
    if (i % 5 == 1) ray.direction = glm::normalize(glm::dvec3{b[0] - 0.5, b[1] - 0.5, 0});
    if (i % 2 == 0) ray.length = 0.01 * side + side * b[2];
    rays.push_back(ray);
  }
  return rays;
}

/// Checks that all exact techniques find the canonical predicate's pairs, and the same bits of irradiance.
void check_all_agree(const Problem& problem, std::uint64_t least_hits) {
  const Outcome expected = truth_of(problem);
  CHECK(expected.total_hits >= least_hits);
  support::check_same_by_all(problem, expected, {tried_candidates()});
}

std::vector<Disc> scaled(std::vector<Disc> discs, double scale, const glm::dvec3& offset) {
  for (Disc& disc : discs) {
    disc.centre = scale * disc.centre + offset;
    disc.radius *= scale;
  }
  return discs;
}

std::vector<Ray> scaled(std::vector<Ray> rays, double scale, const glm::dvec3& offset) {
  for (Ray& ray : rays) {
    ray.origin = scale * ray.origin + offset;
    ray.length *= scale;
  }
  return rays;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("all exact techniques find the predicate's hits: isotropic lines, samples in a volume and on faces") {
    for (const Body body : {Body::cube, Body::cube_faces}) {
      const auto discs = uniform_discs(body, 2, 3000, 0.03, 5);
      const auto rays = LineField(enclosing_sphere(discs), 6).lines(0, 3000);
      check_all_agree(make_problem(rays, discs), 1000);
    }
  }

  TEST_CASE("… lines and segments, radii that vary by a factor of 100, fronts only and both faces") {
    auto discs = uniform_discs(Body::cube, 2, 2000, 0.003, 7);
    for (std::size_t i = 0; i < discs.size(); ++i) discs[i].radius *= std::pow(100.0, static_cast<double>(i % 97) / 96);
    const auto rays = mixed_rays(3000, 3, 8);
    for (const bool front : {false, true}) check_all_agree(make_problem(rays, discs, front), 1000);
  }

  TEST_CASE("… in tiny and huge scenes, and far from the origin") {
    const auto discs = uniform_discs(Body::cube_faces, 2, 1000, 0.05, 9);
    const auto rays = mixed_rays(2000, 3, 10);
    struct Place {
      double scale;
      glm::dvec3 offset;
    };
    for (const Place& place :
         {Place{1e-9, {}}, Place{1e9, {}}, Place{1, glm::dvec3{1e6}}, Place{1e-3, {5e6, 5e5, 0}}}) {
      const auto moved_discs = scaled(discs, place.scale, place.offset);
      const auto moved_rays = scaled(rays, place.scale, place.offset);
      check_all_agree(make_problem(moved_rays, moved_discs), 500);
    }
  }

  TEST_CASE("… with all discs in one plane, on one line, in one point, or all but one") {
    const auto rays = mixed_rays(1000, 2, 11);
    for (const int kept : {2, 1, 0}) {
      auto discs = uniform_discs(Body::cube, 1, 200, 0.1, 12);
      for (Disc& disc : discs)
        for (int axis = kept; axis < 3; ++axis) disc.centre[axis] = 0.25;
      check_all_agree(make_problem(rays, discs), 100);
      check_all_agree(make_problem(rays, std::span(discs).first(1)), 0);
    }
  }

  TEST_CASE("… with discs and rays on the planes between cells") {
    std::vector<Disc> discs;
    std::vector<Ray> rays;
    for (int x = 0; x <= 8; ++x)
      for (int y = 0; y <= 8; ++y) {
        discs.push_back({{x / 8.0, y / 8.0, 0.5}, {0, 0, 1}, 1.0 / 16});
        discs.push_back({{x / 8.0, y / 8.0, 0.25}, {1, 0, 0}, 1.0 / 8});
        rays.push_back({.origin = {x / 8.0, y / 8.0, -1}, .direction = {0, 0, 1}});
        rays.push_back({.origin = {-1, x / 8.0, y / 8.0}, .direction = {1, 0, 0}, .length = 3});
        rays.push_back({.origin = {x / 8.0, y / 8.0, 0}, .direction = glm::normalize(glm::dvec3{1, 1, 1})});
      }
    check_all_agree(make_problem(rays, discs), 100);
  }

  TEST_CASE("… with the plain engine too, in doubles alone") {
    const auto discs = uniform_discs(Body::cube, 2, 700, 0.08, 7);
    const auto rays = mixed_rays(1000, 3, 8);
    const Problem problem = make_problem(rays, discs);
    const Outcome expected = truth_of(problem);
    CHECK(expected.total_hits > 500);
    support::check_same_by_all(problem, expected, {support::float_candidates(), {Engine::plain}});
  }

  TEST_CASE("a run without counting finds the same hits and counts nothing but hits") {
    const auto discs = uniform_discs(Body::cube, 2, 500, 0.1, 1);
    const auto rays = LineField(enclosing_sphere(discs), 2).lines(0, 500);
    const Problem problem = make_problem(rays, discs);
    const Outcome expected = truth_of(problem);
    for (const Candidate& candidate : tried_candidates()) {
      const Outcome counted = run(problem, candidate);
      CHECK(counted.irradiance == expected.irradiance);
      const Outcome timed = run(problem, candidate, {.count = false});
      CHECK(counted.irradiance == timed.irradiance);
      CHECK(timed.counts == Counts<std::uint64_t>{.hits = counted.total_hits});
    }
  }

  TEST_CASE("every technique has its own entry, which prepares its search") {
    for (const Technique technique : all_techniques) {
      CAPTURE(name(technique));
      CHECK(sim::search_of(technique).technique == technique);
      CHECK((sim::search_of(technique).prepare != nullptr));
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("one ray through one disc gives its power divided by the disc's area") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 2}};
    const std::vector<Ray> rays{{.origin = {0, 0, -1}, .direction = {0, 0, 1}, .power = 3}};
    const Outcome outcome = run(make_problem(rays, discs), brute);
    CHECK(outcome.total_hits == 1);
    CHECK(outcome.irradiance[0] == 3 / std::numbers::pi / 4);
    CHECK(outcome.counts.disc_tests == 1);
  }

  TEST_CASE("the counts are consistent") {
    const auto discs = uniform_discs(Body::cube, 2, 700, 0.05, 1);
    const auto rays = LineField(enclosing_sphere(discs), 2).lines(0, 900);
    const Problem problem = make_problem(rays, discs);
    CHECK(run(problem, brute).counts.disc_tests == 700 * 900);
    CHECK(run(problem, brute).counts.segments == 0);
    auto one_ends = rays;
    one_ends.back().length = 1;
    CHECK(run(make_problem(one_ends, discs), brute).counts.segments == 900);
    const Outcome cache = run(problem, {Technique::sphere_cache, SphereCacheParameters{0.5, 4}});
    CHECK(cache.spheres.size() == 4);
    CHECK(cache.spheres[0].tests == 900 * cache.spheres[0].rebuilds);
    CHECK(cache.counts.sorted == 700);
    std::uint64_t tests = 0;
    for (const SphereCounts& sphere : cache.spheres) tests += sphere.tests;
    CHECK(cache.counts.cull_tests == tests);
    const Outcome shallow = run(problem, {Technique::cell_spheres, CellSpheresParameters{1}});
    CHECK(shallow.counts.culls == 8);
    CHECK(shallow.counts.cull_tests == 8 * 900);
    CHECK(shallow.counts.listed <= 8 * 900);
    CHECK(shallow.counts.sorted == 700);
    const Outcome leaf = run(problem, {Technique::sphere_tree, SphereTreeParameters{8, 700}});
    CHECK(leaf.counts.culls == 1);
    CHECK(leaf.counts.cull_tests == 900);
    CHECK(leaf.counts.disc_tests == 700 * leaf.counts.listed);
    const Outcome tree = run(problem, {Technique::sphere_tree, SphereTreeParameters{8, 10}});
    CHECK(tree.counts.culls == 70 + 9 + 2 + 1);
    CHECK(tree.counts.sorted == 700);
    const Outcome grid = run(problem, {Technique::grid, GridParameters{1}});
    CHECK(grid.counts.references == 700);
    CHECK(grid.counts.disc_tests == 700 * grid.counts.steps);
    const Outcome octree = run(problem, {Technique::octree, OctreeParameters{4}});
    const Outcome cells = run(problem, {Technique::grid, GridParameters{16}});
    CHECK(octree.counts.references == cells.counts.references);
    // The octree's cube is slightly larger than the grid's box, so rays meet its outer leaves more often than outer
    // cells.
    CHECK(octree.counts.disc_tests >= cells.counts.disc_tests);
    CHECK(static_cast<double>(octree.counts.disc_tests) < 1.01 * static_cast<double>(cells.counts.disc_tests));
  }

  TEST_CASE("a sphere cache without spheres tests every pair, and the paper's walk then loses nothing") {
    const auto discs = uniform_discs(Body::cube, 2, 300, 0.05, 1);
    const auto rays = LineField(enclosing_sphere(discs), 2).lines(0, 400);
    const Problem problem = make_problem(rays, discs);
    const Outcome truth = run(problem, brute, {.pairs = true});
    for (const Technique technique : {Technique::sphere_cache, Technique::sphere_cache_published})
      for (const bool plain : {false, true}) {
        const Outcome outcome = run(problem, {technique, SphereCacheParameters{0.65, 0}},
                                    {.pairs = true, .engine = plain ? Engine::plain : Engine::simd});
        CHECK(outcome.pairs == truth.pairs);
        CHECK(outcome.counts.disc_tests == 300 * 400);
        CHECK(outcome.counts.cull_tests == 0);
        CHECK(outcome.spheres.empty());
      }
  }

  TEST_CASE("the paper's walk loses hits and finds no false ones") {
    const auto discs = uniform_discs(Body::cube, 2, 10'000, 0.02, 3);
    const auto rays = LineField(enclosing_sphere(discs), 4).lines(0, 10'000);
    const Problem problem = make_problem(rays, discs);
    const Outcome all = run(problem, {Technique::sphere_cache, SphereCacheParameters{0.8, 15}}, {.pairs = true});
    const Outcome some =
        run(problem, {Technique::sphere_cache_published, SphereCacheParameters{0.8, 15}}, {.pairs = true});
    CHECK(some.total_hits < 9 * all.total_hits / 10);
    CHECK(std::includes(all.pairs.begin(), all.pairs.end(), some.pairs.begin(), some.pairs.end()));
  }

  TEST_CASE("a stop request ends a run early and is reported") {
    const auto discs = uniform_discs(Body::cube, 2, 500, 0.1, 1);
    const auto rays = LineField(enclosing_sphere(discs), 2).lines(0, 500);
    std::stop_source source;
    source.request_stop();
    const Problem problem = make_problem(rays, discs);
    const std::uint64_t all = run(problem, brute).total_hits;
    for (const Candidate& candidate : tried_candidates()) {
      const Outcome outcome = run(problem, candidate, {.stop = source.get_token()});
      CHECK(outcome.stopped);
      CHECK(outcome.total_hits < all);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("invalid rays and discs are refused by name") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Disc> discs{{}};
    const std::vector<Ray> rays{{}};
    const auto refuses = [](const std::vector<Ray>& some_rays, const std::vector<Disc>& some_discs, const char* what) {
      CHECK_THROWS_WITH_AS(static_cast<void>(make_problem(some_rays, some_discs)), doctest::Contains(what),
                           std::invalid_argument);
    };
    refuses({}, discs, "at least one ray");
    refuses(rays, {}, "at least one disc");
    refuses({{.origin = {nan, 0, 0}}}, discs, "ray 0: origin must be finite");
    refuses({{.direction = {0, 0, 0}}}, discs, "ray 0: direction must be non-zero");
    refuses({{.length = 0}}, discs, "ray 0: length must be > 0");
    refuses({{.length = nan}}, discs, "ray 0: length must be > 0");
    refuses({{.power = -1}}, discs, "ray 0: power must be >= 0");
    refuses({{.origin = {1e150, 0, 0}}}, discs, "within 1e100");
    refuses(rays, {{.centre = {0, unbounded, 0}}}, "disc 0: centre must be finite");
    refuses(rays, {{.normal = {0, 0, 0}}}, "disc 0: normal must be non-zero");
    refuses(rays, {{.radius = 0}}, "disc 0: radius must be > 0");
    refuses(rays, {{.radius = 1e-200}}, "disc 0: radius must be from 1e-100");
  }

  TEST_CASE("parameters out of range or of another technique are refused, and so is what does not fit in memory") {
    const std::vector<Disc> discs{{.centre = {0, 0, 0}, .radius = 0.1}, {.centre = {1, 1, 1}, .radius = 0.1}};
    const std::vector<Ray> rays{{}};
    const Problem problem = make_problem(rays, discs);
    const auto try_run = [&](const Candidate& candidate) { static_cast<void>(run(problem, candidate)); };
    CHECK_THROWS_AS(try_run({Technique::octree, GridParameters{4}}), std::invalid_argument);
    CHECK_THROWS_AS(try_run({Technique::octree, OctreeParameters{21}}), std::invalid_argument);
    CHECK_THROWS_AS(try_run({Technique::grid, GridParameters{0}}), std::invalid_argument);
    CHECK_THROWS_AS(try_run({Technique::bsp, BspParameters{65, 1}}), std::invalid_argument);
    CHECK_THROWS_AS(try_run({Technique::bsp, BspParameters{8, 0}}), std::invalid_argument);
    for (const double bad : {0.0, 1.0, -0.5, 1.5, std::numeric_limits<double>::quiet_NaN()})
      CHECK_THROWS_AS(try_run({Technique::sphere_cache, SphereCacheParameters{bad, 3}}), std::invalid_argument);
    CHECK_THROWS_AS(try_run({Technique::sphere_cache, SphereCacheParameters{0.5, -1}}), std::invalid_argument);
    CHECK_THROWS_WITH_AS(try_run({Technique::grid, GridParameters{100'000}}), doctest::Contains("GB"),
                         std::length_error);
  }
}
