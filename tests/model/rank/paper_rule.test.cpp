#include "detp/model/rank/choose.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "detp/model/disc_index/disc_index_published.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "support/not_a_length.hpp"

using namespace detp;
using namespace detp::model;
using doctest::Contains;

namespace {

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
