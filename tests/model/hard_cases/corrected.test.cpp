#include <doctest/doctest.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <string>
#include <vector>

#include "detp/model/rank/predict.hpp"
#include "draw.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

/// One candidate of each technique that has a corrected form, with parameters from their whole range.
std::vector<Candidate> draw_candidates(Draw& draw) {
  const double ratio = draw.ratio();
  const auto order = draw.whole(0, 3) > 0 ? SampleOrder::lebesgue : SampleOrder::none;
  // Some of these numbers of spheres are far larger than the number of spheres that can hold a disc. They are at most
  // 1000, to save time.
  const std::int64_t spheres =
      draw.whole(0, 7) > 0 ? draw.whole(1, 40) : std::min<std::int64_t>(draw.index(ratio), 1000);
  return {{Technique::brute_force, BruteForceParameters{}},
          {Technique::sphere_cache, SphereCacheParameters{ratio, spheres, order}},
          {Technique::cell_spheres, CellSpheresParameters{static_cast<int>(draw.whole(0, 16))}},
          {Technique::sphere_tree,
           SphereTreeParameters{static_cast<int>(draw.count(2, 1e6)), static_cast<int>(draw.count(1, 1e6))}},
          {Technique::box_tree,
           BoxTreeParameters{static_cast<int>(draw.count(2, 100)), static_cast<int>(draw.count(1, 1e3))}},
          {Technique::octree, OctreeParameters{static_cast<int>(draw.whole(0, 20))}},
          {Technique::grid, GridParameters{static_cast<int>(draw.count(1, 1e6))}}};
}

std::string describe(const Workload& w, const Candidate& candidate) {
  return fmt::format("{} {}: n_R {:g}, n_P {:g}, d {:a}, r0 {:a}, box {:a} {:a} {:a}, D {:a}",
                     name(candidate.technique), detp::describe(candidate), w.rays, w.samples, w.disc_radius,
                     w.sphere_radius, w.box[0], w.box[1], w.box[2], w.dimension);
}

/// Tables and fits have no exact value to compare with, but every input must give valid counts.
void require_counts(std::uint64_t index) {
  Draw draw(90, index);
  Workload w = draw.workload();
  const std::int64_t kind = draw.whole(0, 2);
  w.dimension = kind == 0 ? 2 : kind == 1 ? 3 : draw.uniform(1, 3);
  for (const Candidate& candidate : draw_candidates(draw)) {
    INFO(describe(w, candidate));
    const Counts<double> counts = model::predict(w, candidate);
    for_each_term(counts, [&](std::string_view term, double value) {
      CAPTURE(term);
      REQUIRE(std::isfinite(value));
      REQUIRE(value >= 0);
    });
    if (!std::holds_alternative<OctreeParameters>(candidate.parameters) &&
        !std::holds_alternative<GridParameters>(candidate.parameters))  // an index tests a disc in each of its cells
      REQUIRE(counts.disc_tests <= w.rays * w.samples * (1 + 1e-12));
  }
}

}  // namespace

TEST_SUITE("corrected") {
  TEST_CASE("every count of every technique is finite and not negative, and no disc meets more rays than there are") {
    for (std::uint64_t index = 0; index < 3000; ++index) require_counts(index);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("a million predictions, seven candidates on each of 170 000 workloads: every count finite, not negative") {
    tbb::parallel_for(std::uint64_t{0}, std::uint64_t{170'000}, require_counts);
  }
}
