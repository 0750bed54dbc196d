#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/emitter.hpp"
#include "detp/validate/accuracy/accuracy_pilot.hpp"
#include "detp/validate/accuracy/error_split.hpp"
#include "detp/validate/accuracy/judged_samples.hpp"

namespace detp::validate {
namespace {

using enum sim::Estimator;

/// A lamp over a black floor of two triangles, which the mesh has once or twice.
sim::Scene floor_under_lamp(bool twice) {
  sim::Scene scene;
  scene.name = "floor";
  sim::Mesh& mesh = scene.mesh;
  mesh.positions = {{0, 0, 0},       {1, 0, 0},       {1, 1, 0},       {0, 1, 0},
                    {0.3, 0.3, 0.5}, {0.3, 0.7, 0.5}, {0.7, 0.7, 0.5}, {0.7, 0.3, 0.5}};
  mesh.triangles = {{4, 5, 6}, {4, 6, 7}, {0, 1, 2}, {0, 2, 3}};
  mesh.materials.all = {{.diffuse = 0}, {.diffuse = 0, .emitted = 1}};
  mesh.materials.of_triangle = {1, 1, 0, 0};
  if (twice) {
    mesh.triangles.push_back({1, 2, 3});
    mesh.triangles.push_back({0, 1, 3});
    mesh.materials.of_triangle.insert(mesh.materials.of_triangle.end(), 2, 0);
  }
  for (const glm::dvec3& position : mesh.positions) scene.box.include(position);
  scene.lights = {{sim::SurfaceLight{}, sim::emitted_flux(mesh)}};
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto place = sim::uniform4(1, sim::Stream::tests, i);
    scene.samples.push_back({{0.2 + 0.6 * place[0], 0.2 + 0.6 * place[1], 0}, {0, 0, 1}});
  }
  return scene;
}

RootInterval stated(sim::Scene& scene, sim::Estimator estimator, double radius) {
  PilotMaker maker(scene, {.estimators = {estimator}, .radii = {radius / 2, radius}});
  const AccuracyPilot pilot = maker.make({400'000, 512});
  const EstimatorPilot& own = pilot.estimators.front();
  return root_of(own.settings.back().bias_squared, own.runs);
}

/// A normal number with mean 0 and variance 1.
double normal(std::uint64_t seed, std::uint64_t number, std::uint64_t purpose) {
  const auto uniform = sim::uniform4(seed, sim::Stream::tests, number, purpose);
  return std::sqrt(-2 * std::log1p(-uniform[0])) * std::cos(2 * std::numbers::pi * uniform[1]);
}

constexpr std::size_t samples = 400;

struct Made {
  std::vector<std::vector<double>> runs;
  std::vector<double> reference;
  std::vector<double> variance;

  [[nodiscard]] ReferenceValues values() const { return {reference, variance}; }
};

/// Irradiance 1 + i mod 3; runs with a standard deviation and a bias, a reference with a standard error.
Made made(std::size_t runs, double deviation, double bias, double reference_error, std::uint64_t seed) {
  Made all{.runs = std::vector<std::vector<double>>(runs, std::vector<double>(samples)),
           .reference = std::vector<double>(samples),
           .variance = std::vector<double>(samples, reference_error * reference_error)};
  for (std::size_t i = 0; i < samples; ++i) {
    const double truth = 1 + static_cast<double>(i % 3);
    all.reference[i] = truth + reference_error * normal(seed, i, 1000);
    for (std::size_t r = 0; r < runs; ++r) all.runs[r][i] = truth + bias + deviation * normal(seed, i, r);
  }
  return all;
}

const double rms = std::sqrt((134 * 1.0 + 133 * 4.0 + 133 * 9.0) / 400);

}  // namespace

TEST_SUITE("bias is judged by what shares nothing with the estimators") {
  TEST_CASE("a floor that is listed twice halves area-corrected estimates only" * doctest::test_suite("long")) {
    sim::Scene twice = floor_under_lamp(true);
    const RootInterval halved = stated(twice, area_corrected, 0.1);
    CHECK(std::abs(halved.value - 0.5) < 0.03);
    CHECK(halved.low > 0.4);
    CHECK(stated(twice, disc, 0.1).high < 0.05);
    sim::Scene once = floor_under_lamp(false);
    CHECK(stated(once, area_corrected, 0.1).high < 0.05);
  }

  TEST_CASE("discs away from edges have no bias in uniform light; those at an edge lose light" *
            doctest::test_suite("long")) {
    sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
    furnace.samples.clear();
    for (int i = 0; i < 25; ++i) furnace.samples.push_back({{0.3 + 0.1 * (i % 5), 0, 0.3 + 0.1 * (i / 5)}, {0, 1, 0}});
    const RootInterval middle = stated(furnace, disc, 0.1);
    CHECK(middle.low == 0);
    CHECK(middle.high < 0.06);
    for (sim::Sample& sample : furnace.samples) sample.position.z = 0;
    const AccuracyPilot pilot = PilotMaker(furnace, {.estimators = {disc}, .radii = {0.1}}).make({400'000, 512});
    const SettingPilot& edge = pilot.estimators.front().settings.front();
    CHECK(edge.mean_bias.mean < -0.1);
    const double same = edge.mean_bias.mean * edge.mean_bias.mean;  // every disc loses alike
    CHECK(std::abs(edge.bias_squared.mean - same) < 4 * edge.bias_squared.standard_error + 0.02);
  }
}

TEST_SUITE("two radii") {
  TEST_CASE("a bias that grows as the radius, or as its square, is inside; without one the interval begins at 0") {
    const std::vector<double> weights(200, 1.0 / 200);
    const auto runs = [&](double bias, std::uint64_t stream) {
      std::vector<std::vector<double>> all(8, std::vector<double>(200));
      for (std::size_t r = 0; r < 8; ++r)
        for (std::size_t i = 0; i < 200; ++i) {
          const double noise = sim::uniform4(stream, sim::Stream::tests, i, r)[0] - 0.5;
          all[r][i] = 1 + bias + 0.1 * noise;
        }
      return all;
    };
    for (const double power : {1.0, 2.0}) {
      const RootInterval found =
          root_of(bias_by_two_radii(runs(-0.2, 1), runs(-0.2 / std::exp2(power), 2), weights), 8);
      CHECK(found.low < 0.2 / 0.8);
      CHECK(found.high > 0.2 / 0.8);
      CHECK(found.low > 0.1 / 0.8);
    }
    const RootInterval none = root_of(bias_by_two_radii(runs(0, 1), runs(0, 2), weights), 8);
    CHECK(none.low == 0);
    CHECK(none.high < 0.05);
    CHECK_THROWS_AS((void)bias_by_two_radii(runs(0, 1), {}, weights), std::invalid_argument);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("judged samples are a subset with weights of sum 1; those without weight are never judged") {
    const sim::Scene cornell = sim::open_scene({.name = "@cornell", .samples = {}});
    std::vector<double> weights = area_weights(cornell);
    for (std::size_t i = 0; i < weights.size(); i += 2) weights[i] = 0;
    const JudgedSamples judged = judged_samples(cornell, 100, weights);
    CHECK(judged.samples.size() == 100);
    CHECK(judged.population == weights.size() / 2);
    CHECK(std::accumulate(judged.weights.begin(), judged.weights.end(), 0.0) == doctest::Approx(1));
    for (std::size_t i = 0; i < judged.places.size(); ++i) {
      CHECK(judged.places[i] % 2 == 1);
      CHECK(judged.samples[i].position == cornell.samples[judged.places[i]].position);
    }
    CHECK(judged_samples(cornell, 1'000'000, weights).samples.size() == judged.population);
  }

  TEST_CASE("paths cut to an overshoot are those that were traced with it") {
    sim::Scene cornell = sim::open_scene({.name = "@cornell", .samples = {}});
    ReplicateMaker maker(cornell, false, 1);
    REQUIRE(maker.overshoot(0.1) > 0);
    const sim::Paths wide = maker.trace(3000, 1, 0.1);
    const std::vector<sim::Ray> cut = with_overshoot(wide, cornell, maker.overshoot(0.02));
    const sim::Paths narrow = maker.trace(3000, 1, 0.02);
    REQUIRE(cut.size() == narrow.rays.size());
    for (std::size_t i = 0; i < cut.size(); ++i)
      CHECK(cut[i].length == doctest::Approx(narrow.rays[i].length).epsilon(1e-9));
  }
}

TEST_SUITE("error split") {
  TEST_CASE("known answer by hand: two samples, three runs") {
    const std::vector<std::vector<double>> runs{{1, 5}, {2, 5}, {3, 5}};
    const std::vector<double> reference{1, 2};
    const std::vector<double> variance{0, 0.25};
    const ErrorSplit split = split_error(runs, {reference, variance});
    const double mean_square = (1 + 4 - 0.25) / 2;
    CHECK(split.noise_squared.mean == doctest::Approx((1.0 + 0) / 2 / mean_square));
    CHECK(split.bias_squared.mean == doctest::Approx((1 - 1.0 / 3 + 9 - 0.25) / 2 / mean_square));
    CHECK(split.total_squared.mean == doctest::Approx(split.noise_squared.mean + split.bias_squared.mean));
  }

  TEST_CASE("light at a sample without any is bias") {
    const std::vector<std::vector<double>> runs{{2, 1}, {2, 1}, {2, 1}};
    const std::vector<double> reference{2, 0};
    const std::vector<double> variance{0, 0};
    CHECK(split_error(runs, {reference, variance}).bias_squared.mean == doctest::Approx(0.25));
  }

  TEST_CASE("noise, bias and total come back without bias; intervals hold as often as they say" *
            doctest::description("400 made-up studies of each kind")) {
    for (const double bias : {0.0, 0.03, 0.3}) {
      CAPTURE(bias);
      constexpr int studies = 400;
      double noise = 0;
      double squared_bias = 0;
      int covered = 0;
      int total_covered = 0;
      const double deviation = 0.4;
      const double known = bias * bias / (rms * rms);
      const double known_noise = deviation * deviation / (rms * rms);
      double spread = 0;
      for (std::uint64_t study = 1; study <= studies; ++study) {
        const Made all = made(8, deviation, bias, 0.05, study);
        const ErrorSplit split = split_error(all.runs, all.values());
        noise += split.noise_squared.mean / studies;
        squared_bias += split.bias_squared.mean / studies;
        spread += std::pow(split.bias_squared.mean - known, 2) / studies;
        const double width = interval_width(0.05, 1, 8);
        covered += std::abs(split.bias_squared.mean - known) <= width * split.bias_squared.standard_error ? 1 : 0;
        total_covered +=
            std::abs(split.total_squared.mean - known - known_noise) <= width * split.total_squared.standard_error ? 1
                                                                                                                   : 0;
      }
      CHECK(noise == doctest::Approx(known_noise).epsilon(0.01));
      CHECK(std::abs(squared_bias - known) < 4 * std::sqrt(spread / studies));
      CHECK(covered >= 0.91 * studies);
      CHECK(total_covered >= 0.91 * studies);
    }
  }

  TEST_CASE("negative controls: the naive square of a mean's error contains noise, a reference's error is bias") {
    const Made all = made(8, 0.4, 0, 0, 1);
    double naive = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      double mean = 0;
      for (const auto& run : all.runs) mean += run[i] / 8;
      naive += std::pow(mean - all.reference[i], 2) / (samples * rms * rms);
    }
    const ErrorSplit split = split_error(all.runs, all.values());
    CHECK(naive > 5 * split.bias_squared.standard_error);
    CHECK(std::abs(split.bias_squared.mean) < 4 * split.bias_squared.standard_error);

    const Made poor = made(8, 0.1, 0, 0.3, 1);
    const std::vector<double> forgotten(samples, 0.0);
    const ErrorSplit wrong = split_error(poor.runs, {poor.reference, forgotten});
    CHECK(wrong.bias_squared.mean > 10 * wrong.bias_squared.standard_error);
    const ErrorSplit right = split_error(poor.runs, poor.values());
    CHECK(std::abs(right.bias_squared.mean) < 4 * right.bias_squared.standard_error);
  }

  TEST_CASE("a root has an interval, and is 0 where the square is below 0") {
    const RootInterval root = root_of({0.04, 0.005}, 8);
    CHECK(root.value == doctest::Approx(0.2));
    CHECK(root.low == doctest::Approx(std::sqrt(0.04 - 2.3646 * 0.005)).epsilon(1e-4));
    CHECK(root.high == doctest::Approx(std::sqrt(0.04 + 2.3646 * 0.005)).epsilon(1e-4));
    const RootInterval none = root_of({-0.001, 0.002}, 8);
    CHECK(none.value == 0);
    CHECK(none.low == 0);
    CHECK(none.high > 0);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("few runs, other samples, numbers that are not finite and darkness are refused") {
    const std::vector<std::vector<double>> runs{{1, 5}, {2, 5}, {3, 5}};
    const std::vector<double> reference{1, 2};
    const std::vector<double> variance{0, 0};
    const auto refuses = [&](std::vector<std::vector<double>> of, const ReferenceValues& with, const char* why) {
      CHECK_THROWS_WITH_AS((void)split_error(of, with), doctest::Contains(why), std::invalid_argument);
    };
    refuses({runs[0], runs[1]}, {reference, variance}, "at least 3 runs (got 2)");
    refuses({runs[0], runs[1], {1}}, {reference, variance}, "same samples");
    refuses(runs, {reference, std::span(variance).first(1)}, "a variance for each");
    refuses({runs[0], runs[1], {1, std::numeric_limits<double>::quiet_NaN()}}, {reference, variance}, "finite");
    const std::vector<double> dark{0, 0};
    refuses(runs, {dark, variance}, "without light");
  }
}

}  // namespace detp::validate
