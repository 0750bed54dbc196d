#include "detp/model/rank/predict.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "support/not_a_length.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;
using support::typical;

namespace {

const Candidate cache{Technique::sphere_cache, SphereCacheParameters{0.65, 8}};
const Candidate boxes{Technique::box_tree, BoxTreeParameters{4, 16}};
const Candidate octree{Technique::octree, OctreeParameters{5}};

bool names(const Workload& workload, const Candidate& candidate, const std::string& reason) {
  const auto reasons = extrapolations(workload, candidate);
  return std::find(reasons.begin(), reasons.end(), reason) != reasons.end();
}

template <class T>
Workload with(T Workload::*member, const T& value) {
  Workload workload = typical;
  workload.*member = value;
  return workload;
}

/// Discs of radius 1/64 in a cube of side 2, with samples X radii apart.
Workload spaced(double x) {
  Workload w = cube_workload(1e6, 1e5, 0x1p-6, 2);
  w.sample_distance = x * w.disc_radius;
  return w;
}

Technique advised_technique(double x, const ProcessorCache& cache = {}) {
  return paper_rule(spaced(x), cache).technique;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("values that the sweep covered are not extrapolated, including the ends of its ranges") {
    for (const double dimension : {2.0, 3.0})
      for (const double samples : {1e3, 1e5, 1e7})
        for (const double share : {1e-4, 0.01, 0.2}) {
          const Workload w = cube_workload(1e5, samples, share / (1 - share) * std::sqrt(3.0), 2, dimension);
          for (const Candidate& candidate :
               {Candidate{}, Candidate{Technique::sphere_cache, SphereCacheParameters{0.9, 7}},
                Candidate{Technique::sphere_cache_published, SphereCacheParameters{0.3, 1}},
                Candidate{Technique::cell_spheres, CellSpheresParameters{4}}, octree,
                Candidate{Technique::sphere_tree, SphereTreeParameters{8, 16}},
                Candidate{Technique::grid, GridParameters{64}}}) {
            CAPTURE(name(candidate.technique));
            CHECK(extrapolations(w, candidate).empty());
          }
        }
    for (const double samples : {1024.0, 1e6}) CHECK(extrapolations(cube_workload(1, samples, 0.02, 2), boxes).empty());
  }

  TEST_CASE("each input outside is named, with its value and the end of the range") {
    CHECK(extrapolations(with(&Workload::samples, 10.0), cache) == std::vector<std::string>{"samples 10 below 1000"});
    CHECK(names(with(&Workload::samples, 1e9), octree, "samples 1e+09 above 1e+07"));
    CHECK(names(with(&Workload::samples, 1e9), boxes, "samples 1e+09 above 1.049e+06"));
    CHECK(names(cube_workload(1e6, 1e5, 1e-5, 2), cache, "d over r0 5.773e-06 below 0.0001"));
    CHECK(names(cube_workload(1e6, 1e3, 1e-5, 2), boxes, "d over sample distance 5e-05 below 0.0009766"));
    CHECK(names(cube_workload(1e6, 1e6, 0.5, 2), boxes, "d over sample distance 25 above 8"));
    CHECK(names(cube_workload(1e6, 1e6, 0.5, 2), boxes, "d over the scene's side 0.25 above 0.16"));
    CHECK(names(with(&Workload::dimension, 2.5), octree, "dimension 2.5 between 2 and 3"));
    CHECK(names(with(&Workload::dimension, 1.5), octree, "dimension 1.5 below 2"));
    CHECK(names(with(&Workload::path_length, 0.3), octree, "rays that end: only lines were counted"));
    CHECK(names(with(&Workload::box, {2, 2, 1}), octree, "box 2 x 2 x 1: only cubes were counted"));
    CHECK(names(with(&Workload::sample_extent, 2.0), cache, "samples that fill 0.25 of the box or its faces, not all"));
    CHECK(names(with(&Workload::sphere_radius, 17.0), cache, "r0 17, not 1.742 around the cube of the samples"));
    CHECK(names(typical, {Technique::sphere_cache, SphereCacheParameters{0.95, 3}}, "Q 0.95 above 0.9"));
    CHECK(
        names(typical, {Technique::sphere_cache, SphereCacheParameters{0.5, 30}}, "k 30: only 7 spheres hold a disc"));
    CHECK(names(typical, {Technique::sphere_cache, SphereCacheParameters{0.5, 3, SampleOrder::none}},
                "samples in no order: only sorted ones were counted"));
    CHECK(names(typical, {Technique::cell_spheres, CellSpheresParameters{9}}, "depth 9 above 6"));
    CHECK(names(typical, {Technique::octree, OctreeParameters{10}}, "depth 10 above 7"));
    CHECK(names(typical, {Technique::grid, GridParameters{500}}, "cells a side 500 above 128"));
    CHECK(names(typical, {Technique::sphere_tree, SphereTreeParameters{2, 64}}, "leaf 64 above 16"));
    CHECK(names(typical, {Technique::sphere_tree, SphereTreeParameters{2, 64}}, "fan-out 2 below 4"));
    CHECK(names(typical, {Technique::box_tree, BoxTreeParameters{17, 64}}, "fan-out 17 above 16"));
    CHECK(names(typical, {Technique::box_tree, BoxTreeParameters{4, 300}}, "leaf 300 above 256"));
  }

  TEST_CASE("brute force is never extrapolated, in any scene") {
    Workload w = with(&Workload::samples, 3.0);
    w.dimension = 2.5;
    w.path_length = 1;
    CHECK(extrapolations(w, {}).empty());
    CHECK(extrapolations(w, {Technique::sphere_cache, SphereCacheParameters{0.65, 0}}).empty());
    CHECK(extrapolations(w, cache).size() == 3);
  }

  TEST_CASE("a ranking and an assessment report why each candidate is extrapolated") {
    for (const Workload& w : {typical, with(&Workload::samples, 50.0)}) {
      for (const Prediction& ranked : rank(w, {})) CHECK(ranked.extrapolated == extrapolations(w, ranked.candidate));
      CHECK(assess(w, cache, {}).extrapolated == extrapolations(w, cache));
    }
    CHECK_FALSE(assess(with(&Workload::samples, 50.0), cache, {}).extrapolated.empty());
  }

  TEST_CASE("for samples up to two radii apart the paper's rule is an index of discs, with cells as wide as a disc") {
    for (const double x : {0.01, 1.0, 1.999, 2.0}) {
      const Candidate candidate = paper_rule(spaced(x));
      REQUIRE(candidate.technique == Technique::octree);
      CHECK(std::get<OctreeParameters>(candidate.parameters).depth == 6);
      CHECK(advised_technique(x, {.bytes = 1e30}) == Technique::octree);
    }
  }

  TEST_CASE("for samples six radii apart or more it is a sphere cache with Q = 0.65, down to the disc") {
    for (const double x : {6.0, 6.001, 100.0}) {
      const Candidate candidate = paper_rule(spaced(x));
      REQUIRE(candidate.technique == Technique::sphere_cache);
      const auto parameters = std::get<SphereCacheParameters>(candidate.parameters);
      CHECK(parameters.ratio == 0.65);
      CHECK(parameters.ratio == published_ratio);
      CHECK(parameters.order == SampleOrder::lebesgue);
      const Workload w = spaced(x);
      CHECK(parameters.spheres == sphere_count(Form::corrected, {0.65}, {w.disc_radius}, {w.sphere_radius}));
      CHECK(advised_technique(x, {.bytes = 1}) == Technique::sphere_cache);
    }
  }

  TEST_CASE("in between, the sphere cache if the rays of the innermost sphere fit the processor's cache") {
    const Workload w = spaced(4);
    const std::int64_t k = sphere_count(Form::corrected, {0.65}, {w.disc_radius}, {w.sphere_radius});
    const double bytes = 64 * published::rays_in_sphere(w.rays, {0.65}, k);
    for (const double x : {2.001, 4.0, 5.999}) {
      CHECK(advised_technique(x, {.bytes = bytes}) == Technique::sphere_cache);
      CHECK(advised_technique(x, {.bytes = bytes * (1 - 1e-12)}) == Technique::octree);
      CHECK(advised_technique(x, {.bytes = bytes, .bytes_per_ray = 65}) == Technique::octree);
      CHECK(advised_technique(x, {.bytes = bytes, .bytes_per_ray = 63}) == Technique::sphere_cache);
    }
  }

  TEST_CASE("the distance between samples is computed from the extent if it is not set") {
    Workload w = cube_workload(1e6, 1e6, 0.02, 2);  // 0.02 apart: X = 1
    CHECK(paper_rule(w).technique == Technique::octree);
    w.disc_radius = 0.002;  // X = 10
    CHECK(paper_rule(w).technique == Technique::sphere_cache);
  }

  TEST_CASE("the candidate that the rule recommends is always in range") {
    for (const double x : {1.0, 4.0, 9.0})
      for (const double disc : {1e-12, 0.1, 5.0, 100.0}) {
        Workload w = spaced(x);
        w.disc_radius = disc;
        w.sample_distance = x * disc;
        CHECK_NOTHROW(check(paper_rule(w)));
      }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a workload or parameters out of range are refused by name") {
    CHECK_THROWS_WITH_AS((void)extrapolations({}, cache), Contains("number of rays"), std::invalid_argument);
    CHECK_THROWS_WITH_AS((void)extrapolations(typical, {Technique::octree, OctreeParameters{99}}), Contains("depth"),
                         std::invalid_argument);
  }

  TEST_CASE("an invalid cache size, ray size or workload is refused by name") {
    for (const double bad : support::not_a_length) {
      CHECK_THROWS_WITH_AS((void)paper_rule(spaced(4), {.bytes = bad}), Contains("processor's cache"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS((void)paper_rule(spaced(4), {.bytes_per_ray = bad}), Contains("bytes of a ray"),
                           std::invalid_argument);
      Workload w = spaced(4);
      w.disc_radius = bad;
      CHECK_THROWS_WITH_AS((void)paper_rule(w), Contains("disc radius"), std::invalid_argument);
    }
  }
}
