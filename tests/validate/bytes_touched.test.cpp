#include "detp/model/vocabulary/bytes_touched.hpp"

#include <doctest/doctest.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "detp/sim/base/page_pool.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "support/machine.hpp"

namespace detp {
namespace {

double bytes_of_faults() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_minflt) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Bytes that a run touches for the first time, after all that is free was given back. Code and small data are ready.
double touched(const sim::Problem& problem, const Candidate& candidate, Counts<double>& counts) {
  static_cast<void>(sim::run(problem, candidate));
  sim::release_kept_pages();
  malloc_trim(0);
  const double before = bytes_of_faults();
  const sim::Outcome outcome = sim::run(problem, candidate);
  counts = as_expected(outcome.counts);
  return bytes_of_faults() - before;
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("the memory that a search touches: page faults of fresh memory" * doctest::test_suite("long")) {
    if (support::sanitized) return;         // a sanitizer keeps freed memory apart
    prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);  // a large page is touched as a whole
    constexpr std::array near{Technique::brute_force, Technique::sphere_cache, Technique::cell_spheres,
                              Technique::box_tree, Technique::bvh};
    constexpr std::array rougher{Technique::octree, Technique::grid, Technique::bsp};
    struct Size {
      std::size_t discs, rays;
      double radius;
    };
    for (const Size& size : {Size{26'000, 60'000, 0.005}, Size{100'000, 30'000, 0.002}, Size{2000, 200'000, 0.004}}) {
      const auto discs = sim::uniform_discs(sim::Body::cube_faces, 1, size.discs, size.radius, 1);
      const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, size.rays);
      const sim::Problem problem = sim::make_problem(rays, discs);
      const auto ratio = [&](Technique technique) {
        const Candidate candidate = default_candidate(technique);
        Counts<double> counts;
        const double found = touched(problem, candidate, counts);
        INFO("name(technique) ", name(technique), ", size.discs ", size.discs, ", found ", found);
        const double expected = bytes_touched(counts, candidate, Engine::simd);
        return std::max(expected, 1e6) / std::max(found, 1e6);  // below a megabyte nothing matters
      };
      for (const Technique technique : near) {
        if (!record_of(technique).built) continue;
        INFO("name(technique) ", name(technique), ", size.discs ", size.discs);
        CHECK(ratio(technique) == doctest::Approx(1).epsilon(0.25));
      }
      for (const Technique technique : rougher) {
        INFO("name(technique) ", name(technique), ", size.discs ", size.discs);
        const double one = ratio(technique);
        CHECK(one > 0.5);
        CHECK(one < 2);
      }
    }
    prctl(PR_SET_THP_DISABLE, 0, 0, 0, 0);
  }
}

}  // namespace detp
