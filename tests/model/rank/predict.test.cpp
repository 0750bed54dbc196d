#include "detp/model/rank/predict.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "detp/model/disc_index/disc_index.hpp"
#include "detp/model/hierarchy/cell_spheres.hpp"
#include "detp/model/hierarchy/sphere_tree.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/sphere_cache/sphere_cache.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "support/not_a_length.hpp"
#include "support/random_workload.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;
using support::typical;

namespace {

const std::vector<Candidate> candidates{
    {Technique::brute_force, BruteForceParameters{}},
    {Technique::sphere_cache, SphereCacheParameters{0.6, 6}},
    {Technique::sphere_cache, SphereCacheParameters{0.6, 6, SampleOrder::none}},
    {Technique::sphere_cache_published, SphereCacheParameters{0.6, 6}},
    {Technique::octree, OctreeParameters{6}},
    {Technique::grid, GridParameters{70}},
    {Technique::cell_spheres, CellSpheresParameters{5}},
    {Technique::sphere_tree, SphereTreeParameters{8, 12}},
};

Workload scaled(Workload w, double factor) {
  w.disc_radius *= factor;
  w.sphere_radius *= factor;
  for (double& side : w.box) side *= factor;
  w.sample_extent *= w.dimension == 3 ? factor * factor * factor : factor * factor;
  w.sample_distance *= factor;
  w.path_length *= factor;
  return w;
}

/// The largest relative difference of any term.
double difference(const Counts<double>& a, const Counts<double>& b) {
  std::vector<double> terms;
  for_each_term(a, [&](std::string_view, double term) { terms.push_back(term); });
  double largest = 0;
  auto other = terms.begin();
  for_each_term(b, [&](std::string_view, double term) {
    largest = std::max(largest, std::abs(*other - term) / std::max({std::abs(*other), std::abs(term), 1e-300}));
    ++other;
  });
  return largest;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("brute force tests every disc against every ray, and does nothing else") {
    const Counts<double> counts = predict(typical, candidates[0], Engine::plain);
    CHECK(counts.disc_tests == 1e11);
    CHECK(counts.hits == expected_hits(typical));
    const Counts<double> expected{.loaded = typical.rays, .visits = 1e5, .disc_tests = 1e11, .hits = counts.hits};
    CHECK(counts == with_bytes_touched(expected, candidates[0], Engine::plain));
  }

  TEST_CASE("rays with a mean path length are segments, others are not; so are those of the best candidate") {
    Workload w = typical;
    w.path_length = 0.1;
    CHECK(predict(w, candidates[0], Engine::plain).segments == typical.rays);
    CHECK(predict(typical, candidates[0], Engine::plain).segments == 0);
    for (const Prediction& one : rank(w, CostTable(UnitCosts{}))) CHECK(one.counts.segments == typical.rays);
    for (const Prediction& one : rank(typical, CostTable(UnitCosts{}))) CHECK(one.counts.segments == 0);
  }

  TEST_CASE("each technique is predicted by its own formulas, plus the rays and the memory") {
    const auto predicted = [](const Candidate& candidate) {
      Counts<double> counts = predict(typical, candidate, Engine::plain);
      CHECK(counts.loaded == typical.rays);
      CHECK(counts.bytes_touched == bytes_touched(counts, candidate, Engine::plain));
      counts.loaded = counts.bytes_touched = 0;
      return counts;
    };
    CHECK(predicted(candidates[1]) == sphere_cache_counts(typical, {0.6, 6}));
    CHECK(predicted(candidates[2]) == sphere_cache_counts(typical, {0.6, 6, SampleOrder::none}));
    CHECK(predicted(candidates[3]) == published::counts(typical, {0.6}, 6));
    CHECK(predicted(candidates[4]) == octree_counts(typical, {6}));
    CHECK(predicted(candidates[5]) == grid_counts(typical, {70}));
    CHECK(predicted(candidates[6]) == cell_sphere_counts(typical, {5}));
    CHECK(predicted(candidates[7]) == sphere_tree_counts(typical, {8, 12}));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the unit of length changes no count by more than 1e-9") {
    std::vector<Workload> workloads{typical, cube_workload(1e4, 1e6, 0.003, 2, 2)};
    workloads.push_back({.rays = 1e5,
                         .samples = 1e4,
                         .disc_radius = 0.02,
                         .sphere_radius = 3,
                         .box = {3, 2, 0.1},
                         .dimension = 2,
                         .sample_extent = 9,
                         .sample_distance = 0.05,
                         .path_length = 1.3});
    for (const Workload& w : workloads)
      for (const Candidate& candidate : candidates)
        for (const double factor : {1e-9, 3.7e-4, 1e9}) {
          INFO("name(candidate.technique) ", name(candidate.technique), ", factor ", factor);
          CHECK(difference(predict(w, candidate, Engine::plain), predict(scaled(w, factor), candidate, Engine::plain)) <
                1e-9);
        }
  }

  TEST_CASE("all techniques expect the same hits, and at least as many disc tests") {
    for (const double path : {0.0, 0.7}) {
      Workload w = typical;
      w.path_length = path;
      for (const Candidate& candidate : candidates) {
        const Counts<double> counts = predict(w, candidate, Engine::plain);
        CHECK(counts.hits == expected_hits(w));
        CHECK(counts.disc_tests >= counts.hits);
        CHECK(counts.disc_tests <= 1e11 * (1 + 1e-12));
      }
    }
  }

  TEST_CASE("twice the rays: twice the tests, the same rebuilds, nodes per ray and references") {
    Workload twice = typical;
    twice.rays *= 2;
    for (const Candidate& candidate : candidates) {
      const Counts<double> one = predict(typical, candidate, Engine::plain);
      const Counts<double> two = predict(twice, candidate, Engine::plain);
      CHECK(two.cull_tests == doctest::Approx(2 * one.cull_tests).epsilon(1e-12));
      CHECK(two.disc_tests == doctest::Approx(2 * one.disc_tests).epsilon(1e-12));
      CHECK(two.nodes == doctest::Approx(2 * one.nodes).epsilon(1e-12));
      CHECK(two.culls == one.culls);
      CHECK(two.references == one.references);
      CHECK(two.placements == one.placements);
    }
  }

  TEST_CASE("every count of every technique is finite and not negative, on random workloads") {
    support::RandomNumbers random(51);
    for (int run = 0; run < 500; ++run) {
      auto [w, ratio] = support::random_workload(random);
      w.dimension = random.uniform(1, 3);
      if (random.whole(0, 1) == 1) w.path_length = w.sphere_radius * random.log_uniform(1e-3, 2);
      const std::vector<Candidate> some{
          {Technique::sphere_cache, SphereCacheParameters{ratio, random.whole(1, 100)}},
          {Technique::sphere_cache_published, SphereCacheParameters{ratio, random.whole(1, 100)}},
          {Technique::cell_spheres, CellSpheresParameters{static_cast<int>(random.whole(0, 16))}},
          {Technique::sphere_tree, SphereTreeParameters{static_cast<int>(random.whole(2, 1048576)),
                                                        static_cast<int>(random.whole(1, 1048576))}},
          {Technique::sphere_tree, SphereTreeParameters{2, 1}},
          {Technique::octree, OctreeParameters{static_cast<int>(random.whole(0, 20))}},
          {Technique::grid, GridParameters{static_cast<int>(random.whole(1, 1048576))}}};
      for (const Candidate& candidate : some) {
        bool good = true;
        for_each_term(predict(w, candidate, Engine::plain),
                      [&](std::string_view, double term) { good = good && std::isfinite(term) && term >= 0; });
        REQUIRE(good);
      }
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a workload out of range is refused by name, for any technique") {
    for (const Candidate& candidate : candidates)
      for (const double bad : support::not_a_count) {
        Workload w = typical;
        w.samples = bad;
        CHECK_THROWS_WITH_AS((void)predict(w, candidate, Engine::plain), Contains("number of samples"),
                             std::invalid_argument);
      }
  }

  TEST_CASE("parameters out of range, or of another technique, are refused") {
    for (const double bad : support::not_a_ratio)
      CHECK_THROWS_WITH_AS(
          (void)predict(typical, {Technique::sphere_cache, SphereCacheParameters{bad, 3}}, Engine::plain),
          Contains("radius ratio Q"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)predict(typical, {Technique::bsp, BspParameters{}}, Engine::plain),
                         Contains("no closed form of bsp"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)predict(typical, {Technique::octree, GridParameters{3}}, Engine::plain),
                         Contains("octree"), std::invalid_argument);
  }

  TEST_CASE("techniques without a closed form are refused") {
    CHECK_THROWS_WITH_AS((void)predict(typical, {Technique::bsp, BspParameters{}}, Engine::plain),
                         Contains("no closed form"), std::invalid_argument);
    for (const Technique technique : {Technique::sphere_cache, Technique::sphere_cache_published})
      CHECK_THROWS_WITH_AS(
          (void)predict(typical, {technique, SphereCacheParameters{0.6, 6, SampleOrder::hilbert}}, Engine::plain),
          Contains("Hilbert"), std::invalid_argument);
  }
}
