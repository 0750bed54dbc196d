#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "detp/model/rank/predict.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/bench/workload.hpp"
#include "detp/validate/choice/comparison.hpp"
#include "detp/validate/job/job.hpp"

using namespace detp;
using namespace detp::validate;

// What a box tree does where discs break the assumption that all are alike, and what the models predict of it.

namespace {

/// Predicted over counted tests of a box tree, or its inverse, whichever is larger.
double off_by(const validate::Job& job, const Workload& workload, const Counts<std::uint64_t>& counted) {
  const Counts<double> predicted = model::predict(workload, Candidate{Technique::box_tree, BoxTreeParameters{8, 16}});
  const double ratio =
      (predicted.cull_tests + predicted.disc_tests) / static_cast<double>(counted.cull_tests + counted.disc_tests);
  INFO(job.name, " ratio ", ratio);
  return std::max(ratio, 1 / ratio);
}

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

TEST_SUITE("statistical") {
  TEST_CASE("with effects by evidence, tests of box trees are predicted within 60 %, without them not") {
    std::vector<double> with;
    std::vector<double> without;
    for (const char* scene : {"@tree", "@courtyard", "@cornell"})
      for (const double radius : {0.0025, 0.02}) {
        validate::JobRequest request;
        request.scene = scene;
        request.rays = 20'000;
        request.disc_radius = validate::Length{radius, true};
        const validate::Job job = validate::make_job(request);
        const sim::Problem& problem = job.problem();
        const auto counted = sim::run(problem, Candidate{Technique::box_tree, BoxTreeParameters{8, 16}}, {}).counts;
        with.push_back(off_by(job, job.workload(), counted));
        const sim::EffectSelection two("surface-samples,finite-paths");
        without.push_back(off_by(job, sim::observe(problem, job.surface, two).workload, counted));
      }
    std::sort(with.begin(), with.end());
    std::sort(without.begin(), without.end());
    CHECK(with[2] < 1.25);
    CHECK(with.back() < 1.6);
    CHECK(without.back() > 2);
  }
}

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

namespace detp::validate {
namespace {

Job room() {
  JobRequest request;
  request.scene = "@cornell";
  request.rays = 2000;
  return make_job(request);
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("one short search is not worth evidence: its workload has no effects, unless they are selected by hand") {
    const Job job = room();
    Question question{.problem = &job.problem(), .purpose = Purpose::one_search};
    CHECK(evidence(question, 2000).dimension == 3);
    CHECK(evidence(question, 2000).rays_end);
    CHECK(evidence(question, 2000).path_length == 0);
    question.effects = sim::EffectSelection("surface-samples");
    CHECK(evidence(question, 2000).dimension < 2.9);
  }

  TEST_CASE("one long search, and many, are worth evidence") {
    const Job job = room();
    Question question{.problem = &job.problem(), .purpose = Purpose::one_search};
    CHECK(evidence(question, 1e7).dimension < 2.9);
    CHECK(evidence(question, 1e7).rays == 1e7);
    question.purpose = Purpose::replans;
    CHECK(evidence(question, 2000).dimension < 2.9);
  }
}

}  // namespace detp::validate
