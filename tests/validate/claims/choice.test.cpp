#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "detp/model/accuracy/scene_error.hpp"
#include "detp/model/rank/choose.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/accuracy/replicates.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/claims/experiments.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

Experiment asking(std::vector<sim::Disc> discs, std::vector<sim::Ray> rays) {
  Experiment experiment;
  const Workload workload = sim::observe(sim::make_problem(rays, discs)).workload;
  experiment.discs = std::move(discs);
  experiment.choice = {workload, std::move(rays)};
  return experiment;
}

std::vector<sim::Disc> discs_in_cube() { return sim::uniform_discs(sim::Body::cube, 2, 2000, 0.05, 3); }

Experiment lines_in_a_cube() {
  const auto discs = discs_in_cube();
  return asking(discs, sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, 4000));
}

Experiment rays_where_nothing_is() {
  auto discs = discs_in_cube();
  std::erase_if(discs, [](const sim::Disc& disc) { return disc.centre.x > 0.5; });
  discs.push_back({.centre = {1, 1, 1}, .radius = 0.05});
  auto rays = sim::LineField({{0.9, 0, 0}, 0.1}, 4).lines(0, 4000);
  for (sim::Ray& ray : rays) ray.length = 0.1;
  return asking(std::move(discs), std::move(rays));
}

/// The finding about this count of the candidate. Fails the test if there is none.
const Finding& of(const std::vector<Finding>& findings, const Prediction& ranked, const std::string& term) {
  const std::string id = "choice." + std::string(name(ranked.candidate.technique)) + "." + term;
  CAPTURE(id);
  const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& one) { return one.id == id; });
  REQUIRE(found != findings.end());
  return *found;
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each count that choose prices is a claim: predicted as choose does, observed as a run counts it") {
    for (const Experiment& experiment : {lines_in_a_cube(), rays_where_nothing_is()}) {
      const std::vector<Finding> findings = choice_findings(experiment);
      const sim::Problem problem = sim::make_problem(experiment.choice->rays, experiment.discs);
      const auto ranking = model::rank(experiment.choice->workload, built_in_unit_costs());
      CHECK(ranking.size() >= 5);
      for (const Prediction& ranked : ranking) {
        const auto counts = as_expected(sim::run(problem, ranked.candidate).counts);
        const auto check = [&](const char* term, double predicted, double counted) {
          if (predicted == 0 && counted == 0) return;
          if (built_in_unit_costs()[ranked.candidate.technique].cull == 0 && term == std::string("culls")) return;
          const Finding& finding = of(findings, ranked, term);
          CHECK(finding.predictions.at(0).value == predicted);
          CHECK(finding.technique == name(ranked.candidate.technique));
          CHECK(finding.parameters == describe(ranked.candidate));
          CHECK(finding.observed.mean == doctest::Approx(counted).epsilon(1e-12));
        };
        check("cull-tests", ranked.counts.cull_tests, counts.cull_tests);
        check("disc-tests", ranked.counts.disc_tests, counts.disc_tests);
        check("steps", ranked.counts.steps, counts.steps);
        check("nodes", ranked.counts.nodes, counts.nodes);
        check("culls", ranked.counts.culls, counts.culls);
        check("placements", ranked.counts.placements, counts.placements);
        check("hits", ranked.counts.hits, counts.hits);
      }
    }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("if the models are valid, no prediction of the choice is refuted and the tests agree") {
    for (const Claim& claim : judge_all(choice_findings(lines_in_a_cube()))) {
      INFO("claim.id ", claim.id, ", claim.relative_difference ", claim.relative_difference);
      CHECK(claim.verdict == Verdict::agrees);
      CHECK(claim.control_verdict == Verdict::refuted);
    }
  }

  TEST_CASE("if rays miss the discs, predicted tests of every index are refuted, and no hits confirmed") {
    const std::vector<Claim> claims = judge_all(choice_findings(rays_where_nothing_is()));
    int refuted = 0;
    for (const Claim& claim : claims) {
      CAPTURE(claim.id);
      // The evidence shows that rays miss the discs near which they pass, so few hits are predicted.
      if (claim.id.find(".hits.") != std::string::npos) CHECK(claim.verdict != Verdict::agrees);
      if (claim.id.starts_with("choice.brute-force") || claim.id.find(".disc-tests.") == std::string::npos) continue;
      CHECK(claim.verdict == Verdict::refuted);
      ++refuted;
    }
    CHECK(refuted >= 5);
  }

  TEST_CASE("if only fronts count, half of the hits of lines are predicted and counted") {
    const Experiment both = lines_in_a_cube();
    Experiment fronts = both;
    fronts.choice->workload =
        sim::observe(sim::make_problem(fronts.choice->rays, fronts.discs, true)).workload;  // as choose measures it
    const std::vector<Claim> claims = judge_all(choice_findings(fronts));
    const std::vector<Claim> of_both = judge_all(choice_findings(both));
    REQUIRE(claims.size() == of_both.size());
    int of_hits = 0;
    for (const Claim& claim : claims) {
      const bool hits = claim.id.find(".hits.") != std::string::npos;
      CAPTURE(claim.id);
      const auto both_faces =
          std::find_if(of_both.begin(), of_both.end(), [&](const Claim& one) { return one.id == claim.id; });
      REQUIRE(both_faces != of_both.end());
      CHECK(claim.verdict == Verdict::agrees);
      CHECK(claim.predicted == (hits ? 0.5 : 1) * both_faces->predicted);
      if (!hits) continue;
      ++of_hits;
      CHECK(claim.observed.mean < 0.55 * both_faces->observed.mean);
      CHECK(claim.observed.mean > 0.45 * both_faces->observed.mean);
    }
    CHECK(of_hits >= 5);
  }

  TEST_CASE("one ray decides nothing; without a question there is no claim, and a stop leaves none half counted") {
    Experiment experiment = lines_in_a_cube();
    experiment.choice->rays.resize(1);
    for (const Claim& claim : judge_all(choice_findings(experiment)))
      if (claim.id.find("culls") == std::string::npos && claim.id.find("placements") == std::string::npos &&
          claim.id.find("visits") == std::string::npos && claim.id.find(".made.") == std::string::npos)
        CHECK(claim.verdict == Verdict::undecided);
    std::stop_source source;
    source.request_stop();
    experiment.stop = source.get_token();
    CHECK(choice_findings(experiment).empty());
    experiment.choice.reset();
    CHECK(choice_findings(experiment).empty());
  }
}

namespace detp::validate {
namespace {

constexpr double irradiance = 2 * std::numbers::pi;

const Finding& named(const std::vector<Finding>& findings, const std::string& id) {
  for (const Finding& one : findings)
    if (one.id == id) return one;
  FAIL("no finding " << id);
  return findings.front();
}

/// In the middle of the floor.
std::vector<sim::Sample> samples_in_the_middle() {
  std::vector<sim::Sample> samples;
  for (int x = 0; x < 8; ++x)
    for (int z = 0; z < 8; ++z) samples.push_back({{0.25 + x / 14.0, 0, 0.25 + z / 14.0}, {0, 1, 0}});
  return samples;
}

/// Mean over the samples of six runs, and its standard error.
template <class Change>
Estimate mean_of(ReplicateMaker& maker, const AccuracySetting& setting, const Change& change) {
  const auto samples = samples_in_the_middle();
  std::vector<double> runs;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    sim::Paths paths = maker.trace(40'000, seed, 0);
    change(paths);
    double mean = 0;
    for (const double one : maker.estimate(paths, samples, setting).irradiance)
      mean += one / static_cast<double>(samples.size());
    runs.push_back(mean);
  }
  return batch_means(runs);
}

}  // namespace

TEST_SUITE("claims about errors") {
  TEST_CASE("no claim about errors is refuted; mutated formulas are" * doctest::test_suite("long")) {
    Experiment experiment;
    experiment.workload = cube_workload(3e5, 100, 0.1, 1, 3);
    const auto findings = accuracy_findings(experiment);
    REQUIRE(findings.size() == 5);
    for (const Claim& claim : judge_all(findings)) {
      CAPTURE(claim.id);
      CHECK(claim.verdict != Verdict::refuted);
      CHECK(claim.control_verdict == Verdict::refuted);
    }
    const auto refutes = [](const Finding& finding, double factor) {
      return judge(factor * finding.predictions[0].value, finding.observed, finding.tolerance, 5) == Verdict::refuted;
    };
    const Finding& noise = named(findings, "accuracy.disc-noise");
    CHECK(refutes(noise, std::numbers::pi));                              // π forgotten
    CHECK(refutes(noise, 0.05));                                          // d for d²
    CHECK(refutes(named(findings, "accuracy.triangle-noise"), 9.0 / 6));  // the ring of a vertex for that of a point
    CHECK(refutes(named(findings, "accuracy.edge-bias"), 0.5));           // edges counted for one face
    const Finding& smooth = named(findings, "accuracy.smooth-bias");
    CHECK(refutes(smooth, 2));                // 1/32 for 1/64
    CHECK(refutes(smooth, 1 / (0.4 * 0.4)));  // d² for d⁴
    // pieces as independent
    const Finding& clumping = named(findings, "accuracy.clumping");
    CHECK(refutes(clumping, 1 / clumping.predictions[0].value));
  }
}

TEST_SUITE("long") {
  TEST_CASE("@furnace: away from edges every estimator is unbiased, and mutated ones are found out") {
    sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
    ReplicateMaker maker(furnace, false, 0);
    const auto unchanged = [](sim::Paths&) {};
    for (const sim::EstimatorRecord& record : sim::estimators) {
      if (record.needs_scene) continue;  // it looks at no photons
      CAPTURE(record.name);
      const AccuracySetting setting{.estimator = record.estimator, .radius = 0.08, .nearest = 100};
      const Estimate mean = mean_of(maker, setting, unchanged);
      CHECK(std::abs(mean.mean - irradiance) < 5 * mean.standard_error);
      CHECK(mean.standard_error < 0.01 * irradiance);
      CHECK(std::abs(mean.mean * std::numbers::inv_pi - irradiance) > 20 * mean.standard_error);  // π twice
      // the cosine twice: rays count by the angle at which they arrive
      const Estimate twice = mean_of(maker, setting, [](sim::Paths& paths) {
        for (sim::Ray& ray : paths.rays) ray.power *= std::abs(ray.direction.y);
      });
      CHECK(std::abs(twice.mean - irradiance) > 20 * twice.standard_error);
      CHECK(std::abs(twice.mean - irradiance * 2 / 3) < 5 * twice.standard_error + 0.01 * irradiance);
    }
  }
}

}  // namespace detp::validate
