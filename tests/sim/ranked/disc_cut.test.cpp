#include "detp/sim/ranked/disc_cut.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/ranked/disc_parts.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/piloted_discs.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// Σ (1 + d²/mean d²) of a part, over that of all parts.
double share_of(const PartOfDiscs& part, double mean_square, std::size_t discs) {
  double cost = 0;
  for (const Disc& disc : part.discs) cost += 1 + disc.radius * disc.radius / mean_square;
  return cost / (2 * static_cast<double>(discs));
}

void check_parts(const std::vector<Disc>& discs, std::size_t parts, double tolerance) {
  const DiscsInMemory source(discs);
  const DiscCut cut(source, parts);
  double squares = 0;
  for (const Disc& disc : discs) squares += disc.radius * disc.radius;
  std::vector<int> found(discs.size());
  DiscParts all(source, cut, 0, parts);
  for (std::size_t i = 0; i < parts; ++i) {
    const PartOfDiscs part = all.take(i);
    CHECK(std::ranges::is_sorted(part.numbers));
    bool same = true;
    for (std::size_t k = 0; k < part.discs.size(); ++k) {
      ++found[part.numbers[k]];
      same = same && part.discs[k].centre == discs[part.numbers[k]].centre;
    }
    CHECK(same);
    const double share = share_of(part, squares / static_cast<double>(discs.size()), discs.size());
    CHECK(share * static_cast<double>(parts) == doctest::Approx(1).epsilon(tolerance));
    const PartOfDiscs alone = DiscParts(source, cut, i, 1).take(0);
    CHECK(alone.numbers == part.numbers);
  }
  CHECK(std::ranges::all_of(found, [](int times) { return times == 1; }));
}

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

const std::vector<Disc>& surface_discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube_faces, 2, 2000, 0.02, 3);
  return all;
}

Outcome search(std::size_t rays, int leaf, Engine engine) {
  const auto lines = LineField(enclosing_sphere(surface_discs()), 7).lines(0, rays);
  return run(make_problem(lines, surface_discs()), {Technique::ray_map, RayMapParameters{leaf}},
             {.pairs = true, .engine = engine});
}

constexpr std::array both_engines{Engine::simd, Engine::plain};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each disc is in one part, and parts have equal cost") {
    std::vector<Disc> discs = uniform_discs(Body::cube, 2, 40'000, 0.01, 3);
    for (std::size_t i = 0; i < discs.size() / 2; ++i) discs[i].radius = 0.05;
    for (const std::size_t parts : {1, 2, 3, 16}) check_parts(discs, parts, 0.01);
  }

  TEST_CASE("discs beyond the sample: parts differ by a few per cent" * doctest::test_suite("long")) {
    const std::vector<Disc> discs = uniform_discs(Body::cube, 2, 1'200'000, 0.01, 3);
    REQUIRE(discs.size() > 2 * DiscCut::most_sampled);
    check_parts(discs, 5, 0.01);
  }

  TEST_CASE("discs at one place, and as many parts as discs") {
    const std::vector<Disc> discs(60, Disc{.centre = {1, 2, 3}, .normal = {0, 0, 1}, .radius = 1});
    check_parts(discs, 2, 0.01);
    check_parts(discs, 60, 0.01);
    CHECK_THROWS_AS(DiscCut(DiscsInMemory(discs), 61), std::invalid_argument);
  }

  TEST_CASE("a tree along a known order is the tree that sorting makes, with every radius and engine") {
    for (const std::size_t count : {1UL, 7UL, 3000UL, 9000UL}) {
      CAPTURE(count);
      const auto sorted = uniform_discs(Body::cube_faces, 2, count, 0.01, 5);
      const DiscOrder order(make_problem_without_rays(sorted, 10), {});
      for (const double radius : {0.001, 0.01, 0.5}) {
        const auto discs = uniform_discs(Body::cube_faces, 2, count, radius, 5);
        const auto lines = LineField(enclosing_sphere(discs), 1).lines(0, 100);
        const Problem problem = make_problem(lines, discs);
        const BoxTreeParameters shape{8, 16};
        for (const Engine engine : {Engine::simd, Engine::plain}) {
          const auto kept = order.prepare(problem, shape, {.engine = engine});
          const auto made = prepare(problem, Candidate{Technique::box_tree, shape}, {.engine = engine});
          CHECK(kept->built().counts.sorted == 0);
          CHECK(kept->built().counts.made == made->built().counts.made);
          const Outcome a = search(*kept, problem, {.engine = engine});
          const Outcome b = search(*made, problem, {.engine = engine});
          CHECK(a.hits == b.hits);
          CHECK(a.irradiance == b.irradiance);
          CHECK(a.counts == b.counts);
        }
      }
    }
  }

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

  TEST_CASE("leaves of any size find the hits of brute force, each once") {
    const auto lines = LineField(enclosing_sphere(surface_discs()), 7).lines(0, 3000);
    const Outcome expected = run(make_problem(lines, surface_discs()), Candidate{}, {.pairs = true});
    REQUIRE(expected.total_hits > 100);
    for (const Engine engine : both_engines)
      for (const int leaf : {1, 16, 1000, 1 << 20}) {
        const Outcome found = search(3000, leaf, engine);
        CHECK(found.pairs == expected.pairs);
        CHECK(found.irradiance == expected.irradiance);
      }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("another number of discs, parameters out of range, a stop request") {
    const auto discs = uniform_discs(Body::cube, 2, 100, 0.1, 5);
    const Problem problem = make_problem_without_rays(discs, 10);
    const DiscOrder order(problem, {});
    const Problem fewer = make_problem_without_rays(std::span(discs).first(50), 10);
    CHECK_THROWS_AS(static_cast<void>(order.prepare(fewer, {8, 16}, {})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(order.prepare(problem, {1, 16}, {})), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(order.prepare(problem, {8, 16}, {.threads = -1})), std::invalid_argument);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(static_cast<void>(order.prepare(problem, {8, 16}, {.stop = source.get_token()})), Stopped);
    CHECK_THROWS_AS(DiscOrder(problem, {.stop = source.get_token()}), Stopped);
  }

  TEST_CASE("no disc, or parameters out of range, are refused") {
    const std::vector<Disc> discs{{}};
    CHECK_THROWS_WITH_AS((void)make_sphere_tree({}, {}, {2, 1}), doctest::Contains("discs"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)make_sphere_tree(discs, as_given(discs), {1, 1}), doctest::Contains("fan-out"),
                         std::invalid_argument);
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

TEST_SUITE("limit") {
  TEST_CASE("with one leaf for all rays it is brute force") {
    for (const Engine engine : both_engines) {
      const Outcome all = search(500, 500, engine);
      CHECK(all.counts.disc_tests == 500 * surface_discs().size());
      CHECK(all.counts.nodes == surface_discs().size());
      CHECK(all.counts.culls == 0);
    }
  }

  TEST_CASE("the ray map tests a small part of the rays; ten times the rays need less than ten times the tests") {
    for (const Engine engine : both_engines) {
      const Counts<std::uint64_t> few = search(1'000, 32, engine).counts;
      const Counts<std::uint64_t> many = search(10'000, 32, engine).counts;
      CHECK(many.disc_tests < 10'000 * surface_discs().size() / 50);
      CHECK(many.disc_tests < 9 * few.disc_tests);
    }
  }

  TEST_CASE("vectors list and test somewhat more rays, because they do not note which rays were tested") {
    const Counts<std::uint64_t> vectors = search(10'000, 32, Engine::simd).counts;
    const Counts<std::uint64_t> plain = search(10'000, 32, Engine::plain).counts;
    CHECK(vectors.listed >= plain.listed);
    CHECK(vectors.listed < 1.3 * static_cast<double>(plain.listed));
    CHECK(vectors.disc_tests > plain.disc_tests);
    CHECK(vectors.disc_tests < 3 * plain.disc_tests);
    CHECK(vectors.doubtful < vectors.disc_tests / 100);
  }

  TEST_CASE("nothing is built where no disc searches: one disc in a corner needs few cells") {
    const std::vector<Disc> pair{{.centre = glm::dvec3{-1}, .radius = 1e-3}, {.centre = glm::dvec3{1}, .radius = 1e-3}};
    const auto lines = LineField(enclosing_sphere(pair), 7).lines(0, 20'000);
    for (const Engine engine : both_engines) {
      const Outcome found =
          run(make_problem(lines, pair), {Technique::ray_map, RayMapParameters{8}}, {.engine = engine});
      CHECK(found.counts.culls < 200);
      CHECK(found.counts.disc_tests < 100);
    }
  }
}
