#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "detp/model/accuracy/scene_error.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/accuracy/replicates.hpp"
#include "detp/validate/claims/experiments.hpp"

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
  TEST_CASE("no claim about errors is refuted; mutated formulas are") {
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
