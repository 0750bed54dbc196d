#include "detp/sim/search/totals.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "detp/sim/geometry/dominant_axis.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

const std::vector<Disc>& few_discs() {
  static const std::vector<Disc> all = uniform_discs(Body::cube, 2, 300, 0.2, 3);
  return all;
}

/// Lines whose powers span ten decades, so that adding in another order gives another sum.
const std::vector<Ray>& few_rays() {
  static const std::vector<Ray> all = [] {
    std::vector<Ray> lines = LineField(enclosing_sphere(few_discs()), 4).lines(0, 1000);
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i].power = std::pow(10, 10 * uniform4(5, Stream::tests, i)[0]);
    return lines;
  }();
  return all;
}

const std::vector<Candidate> candidates{{Technique::brute_force, BruteForceParameters{}},
                                        {Technique::sphere_cache, SphereCacheParameters{0.6, 4}},
                                        {Technique::cell_spheres, CellSpheresParameters{3}},
                                        {Technique::sphere_tree, SphereTreeParameters{8, 4}},
                                        {Technique::box_tree, BoxTreeParameters{8, 4}},
                                        {Technique::octree, OctreeParameters{3}},
                                        {Technique::grid, GridParameters{8}}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("irradiance adds powers by dominant axis, each sum in ray order, then x + y + z") {
    for (const Candidate& candidate : candidates) {
      CAPTURE(name(candidate.technique));
      const Outcome outcome = run(make_problem(few_rays(), few_discs()), candidate, {.pairs = true});
      std::vector<glm::dvec3> by_axis(few_discs().size());
      std::vector<double> plain(few_discs().size());
      for (const Pair& pair : outcome.pairs) {
        const Ray& ray = few_rays()[pair.ray];
        by_axis[pair.disc][dominant_axis(ray.direction)] += ray.power;
        plain[pair.disc] += ray.power;
      }
      int others = 0;
      for (std::size_t i = 0; i < few_discs().size(); ++i) {
        const double area = std::numbers::pi * 0.2 * 0.2;
        CHECK(outcome.irradiance[i] == (by_axis[i].x + by_axis[i].y + by_axis[i].z) / area);
        others += outcome.irradiance[i] != plain[i] / area ? 1 : 0;
      }
      CHECK(others > 30);
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("blocks of rays that continue one another's totals give the bits of one run over all rays") {
    const Outcome whole = run(make_problem(few_rays(), few_discs()), candidates[0], {.engine = Engine::plain});
    for (const Candidate& candidate : candidates) {
      CAPTURE(name(candidate.technique));
      Totals totals;
      std::uint64_t hits = 0;
      for (const auto& [first, count] : {std::pair{0, 1}, {1, 7}, {8, 500}, {508, 492}}) {
        const Problem block = make_problem(std::span(few_rays()).subspan(first, count), few_discs());
        const Outcome part = run(block, candidate, {.totals = &totals});
        CHECK(part.hits.empty());
        CHECK(part.irradiance.empty());
        CHECK(part.counts.hits == part.total_hits);
        hits += part.total_hits;
      }
      Outcome joined;
      finish(totals, few_discs(), joined);
      CHECK(hits == whole.total_hits);
      CHECK(joined.hits == whole.hits);
      CHECK(joined.irradiance == whole.irradiance);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("totals of other discs and invalid numbers of threads are refused") {
    const Problem problem = make_problem(few_rays(), few_discs());
    const auto try_run = [&](const RunOptions& options) { static_cast<void>(run(problem, candidates[0], options)); };
    Totals others(few_discs().size() - 1);
    CHECK_THROWS_WITH_AS(try_run({.totals = &others}), doctest::Contains("totals of 299 discs"), std::invalid_argument);
    for (const int threads : {-1, 4097})
      CHECK_THROWS_WITH_AS(try_run({.threads = threads}), doctest::Contains("number of threads"),
                           std::invalid_argument);
  }
}
