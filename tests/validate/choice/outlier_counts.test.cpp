// What a box tree does where discs break the assumption that all are alike, and what the models predict of it.

#include <doctest/doctest.h>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/bench/workload.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

struct Compared {
  Counts<double> predicted;
  Counts<double> without;  ///< predicted as if all discs were alike and near
  Counts<std::uint64_t> counted;
};

Compared compare(AwkwardScene scene, double radius, std::size_t lines, const BoxTreeParameters& parameters) {
  const auto discs = awkward_discs(scene, 10'000, radius, 1);
  const auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, lines);
  const sim::Problem problem = sim::make_problem(rays, discs);
  const Candidate tree{Technique::box_tree, parameters};
  const Workload workload = sim::observe(problem).workload;
  Workload alike = workload;
  alike.radii.clear();
  alike.nodes.clear();
  alike.ray_density = 1;
  return {model::predict(workload, tree), model::predict(alike, tree), sim::run(problem, tree, {}).counts};
}

double ratio(double predicted, std::uint64_t counted) { return predicted / static_cast<double>(counted); }

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("tests of discs with mixed radii are predicted to a third; with equal radii they would be far too few") {
    for (const double radius : {0.0025, 0.01, 0.04}) {
      CAPTURE(radius);
      const Compared tree = compare(AwkwardScene::mixed_radii, radius, 1000, {8, 32});
      const double tests = ratio(tree.predicted.disc_tests, tree.counted.disc_tests);
      const double culls = ratio(tree.predicted.cull_tests, tree.counted.cull_tests);
      CHECK(tests > 0.67);
      CHECK(tests < 1.1);
      CHECK(culls > 0.9);
      CHECK(culls < 1.1);
    }
    const Compared large = compare(AwkwardScene::mixed_radii, 0.04, 1000, {8, 32});
    CHECK(ratio(large.without.disc_tests, large.counted.disc_tests) < 0.5);
  }

  TEST_CASE("with a few discs far away, tests of boxes are predicted to a tenth; with one box they would be too many") {
    const Compared tree = compare(AwkwardScene::strays, 0.01, 20'000, {8, 32});
    const double culls = ratio(tree.predicted.cull_tests, tree.counted.cull_tests);
    CHECK(culls > 0.9);
    CHECK(culls < 1.1);
    CHECK(ratio(tree.without.cull_tests, tree.counted.cull_tests) > 2);
  }
}
