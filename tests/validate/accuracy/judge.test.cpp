#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/emitter.hpp"
#include "detp/validate/accuracy/accuracy_pilot.hpp"
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

}  // namespace detp::validate
