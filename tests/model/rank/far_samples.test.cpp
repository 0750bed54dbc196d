#include "detp/model/rank/far_samples.hpp"

#include <doctest/doctest.h>

#include "detp/model/rank/choose.hpp"
#include "detp/model/rank/predict.hpp"
#include "detp/model/vocabulary/cost_table.hpp"

using namespace detp;

namespace {

const UnitCosts simple_costs{.cull_test = 1, .disc_test = 1, .listed = 1, .cull = 20};

/// A cube of side 2 in the middle of a scene of side 600 that holds 5 more samples.
Workload with_strays(double rays, double samples) {
  Workload w = cube_workload(rays, samples, 0.01, 600);
  const Workload cube = cube_workload(rays, samples - 5, 0.01, 2);
  const double ratio = cube.sphere_radius / w.sphere_radius;
  w.central = CentralSamples{
      .samples = samples - 5, .sphere_radius = cube.sphere_radius, .box = cube.box, .ray_share = ratio * ratio};
  return w;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("central and far samples are workloads of their own") {
    const Workload w = with_strays(1e9, 1e5);
    const Workload central = model::central_workload(w);
    const Workload cube = cube_workload(central.rays, 1e5 - 5, 0.01, 2);
    CHECK(central.samples == cube.samples);
    CHECK(central.sphere_radius == cube.sphere_radius);
    CHECK(central.box == cube.box);
    CHECK(central.rays == std::round(1e9 * w.central->ray_share));
    CHECK_FALSE(central.central);
    const Workload far = model::far_workload(w, 8);
    CHECK(far.samples == 13);
    CHECK(far.rays == w.rays);
    CHECK(far.box == w.box);
    CHECK_FALSE(far.central);
    CHECK(model::central_workload(with_strays(10, 100)).rays == 1);
  }

  TEST_CASE("each disc is sorted once, and hits are those of all discs") {
    const Workload w = with_strays(1e6, 1e5);
    Workload together = w;
    together.central.reset();
    const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 32}};
    const Counts<double> apart = model::predict(w, tree);
    CHECK(apart.sorted == w.samples);
    CHECK(apart.hits == model::predict(together, tree).hits);
    CHECK(apart.loaded == w.rays);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("rays that miss the central samples are tested with the children of the root, hardly with more") {
    const Counts<double> counts =
        model::predict(with_strays(1e5, 1e5), {Technique::box_tree, BoxTreeParameters{8, 32}});
    CHECK(counts.cull_tests / 1e5 > 7);
    CHECK(counts.cull_tests / 1e5 < 9);
    CHECK(counts.disc_tests / 1e5 < 0.1);
  }

  TEST_CASE("the best leaf is that for the central samples; if most rays miss them, the root has few children") {
    const Workload w = with_strays(1e9, 1e5);
    const auto best = model::best_of(Technique::box_tree, w, simple_costs);
    const auto central = model::best_of(Technique::box_tree, model::central_workload(w), simple_costs);
    REQUIRE(best);
    REQUIRE(central);
    const auto& tree = std::get<BoxTreeParameters>(best->candidate.parameters);
    CHECK(tree.leaf == std::get<BoxTreeParameters>(central->candidate.parameters).leaf);
    CHECK(tree.fan_out == 4);
    CHECK(best->counts == model::predict(w, best->candidate));
  }
}
