#include "detp/validate/accuracy/reference.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/accuracy/replicates.hpp"

namespace detp::validate {
namespace {

sim::Scene opened(const char* name, std::vector<sim::LightKind> lights = {}) {
  return sim::open_scene({.name = name, .samples = {}, .lights = std::move(lights)});
}

}  // namespace

TEST_SUITE("references") {
  TEST_CASE("a known irradiance is taken, but not with other lights") {
    const sim::Scene furnace = opened("@furnace");
    const Reference reference = make_reference(furnace, {.samples = 50});
    CHECK(reference.kind == ReferenceKind::known);
    CHECK(reference.judged.samples.size() == 50);
    CHECK(reference.irradiance == std::vector<double>(50, 2 * std::numbers::pi));
    CHECK(reference.error() == 0);
    CHECK(make_reference(opened("@furnace", {sim::LightKind::point}), {.samples = 20, .error = 0.3}).kind ==
          ReferenceKind::backward);
  }

  TEST_CASE("backward paths reach the error that is asked for; the bytes do not depend on threads") {
    const sim::Scene cornell = opened("@cornell");
    const Reference one = make_reference(cornell, {.samples = 60, .error = 0.05});
    CHECK(one.kind == ReferenceKind::backward);
    CHECK(one.error() <= 0.05);
    CHECK_FALSE(one.stopped);
    ReferenceOptions options{.samples = 60, .error = 0.05};
    const Reference again = make_reference(cornell, options);
    CHECK(again.irradiance == one.irradiance);
    options.threads = 1;
    CHECK(make_reference(cornell, options).irradiance == one.irradiance);
  }

  TEST_CASE("photons on small patches agree with backward paths: the difference is within the errors" *
            doctest::test_suite("long")) {
    const sim::Scene cornell = opened("@cornell");
    const Reference backward = make_reference(cornell, {.samples = 200, .error = 0.02});
    sim::Scene mutable_scene = cornell;
    ReplicateMaker maker(mutable_scene, false, 0);
    std::vector<std::vector<double>> runs;
    const AccuracySetting patches{.estimator = sim::Estimator::area_corrected, .radius = 0.02};
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
      runs.push_back(maker.estimate(maker.trace(200'000, seed, 0), backward.judged.samples, patches).irradiance);
    const ErrorSplit split = split_error(runs, backward.values());
    // Half a cell of bias remains where shadows have edges.
    CHECK(root_of(split.bias_squared, runs.size()).low < 0.04);
    // Negative control: a reference that is 10 % too bright is found out.
    std::vector<double> bright = backward.irradiance;
    for (double& one : bright) one *= 1.1;
    CHECK(
        root_of(split_error(runs, {bright, backward.variance, backward.judged.weights}).bias_squared, runs.size()).low >
        0.05);
  }
}

TEST_SUITE("long") {
  TEST_CASE("light that backward paths miss comes from photons: together they are the light of all photons") {
    sim::Scene caustic = opened("@caustic");
    const Reference reference = make_reference(caustic, {.samples = 200, .error = 0.1, .seconds = 20});
    CHECK(reference.kind == ReferenceKind::both);
    CHECK(reference.photons > 1'000'000);
    CHECK(reference.missed_mean > 0.01);
    ReplicateMaker maker(caustic, false, 0);
    std::vector<std::vector<double>> runs;
    const AccuracySetting patches{.estimator = sim::Estimator::triangle_hits};
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
      runs.push_back(maker.estimate(maker.trace(200'000, seed, 0), reference.judged.samples, patches).irradiance);
    const ErrorSplit split = split_error(runs, reference.values());
    CHECK(std::abs(split.mean_bias.mean) < 4 * split.mean_bias.standard_error + 0.02);
    CHECK(std::abs(split.mean_bias.mean) < 0.5 * reference.missed_mean);  // without the photons it would be all of it
  }
}

TEST_SUITE("the judge's light") {
  TEST_CASE("missed light that no photon brings to the samples is bounded, not 0") {
    // So few photons bring nothing to three samples.
    sim::Scene caustic = opened("@caustic");
    ReferenceMaker maker(caustic, judged_samples(caustic, 3), {});
    maker.add_paths(16);
    maker.add_photons(100, 2);
    const Estimate missed = maker.reference().missed_squared;
    CHECK(missed.mean == 0);
    CHECK(missed.standard_error > 0.01);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("scenes without triangles and options out of range are refused") {
    CHECK_THROWS_WITH_AS((void)make_reference(opened("@uniform")), doctest::Contains("triangles"),
                         std::invalid_argument);
    const sim::Scene cornell = opened("@cornell");
    CHECK_THROWS_AS((void)make_reference(cornell, {.samples = 0}), std::invalid_argument);
    CHECK_THROWS_AS((void)make_reference(cornell, {.error = 0}), std::invalid_argument);
    CHECK_THROWS_AS((void)make_reference(cornell, {.seconds = -1}), std::invalid_argument);
  }

  TEST_CASE("a stop request before the first values is an error of its own") {
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS((void)make_reference(opened("@cornell"), {.stop = source.get_token()}), sim::Stopped);
  }
}

}  // namespace detp::validate
