#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/emitter.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

std::vector<Disc> discs_of(const Scene& scene, double radius) {
  std::vector<Disc> discs;
  for (const Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, radius});
  return discs;
}

/// The walls of @furnace in other colours: one whose largest shares add up to more than 1, with gloss.
Scene coloured_furnace(const Colours& colours) {
  Scene scene = open_scene({.name = "@furnace", .samples = 100});
  scene.mesh.materials.all.front().colours = colours;
  scene.mesh.materials.all.front().shininess = 20;
  scene.mesh.materials.take_largest();
  scene.rgb = true;
  scene.lights = {{SurfaceLight{}, emitted_flux(scene.mesh)}};
  return scene;
}

/// In units of its standard error.
double deviation(double found, double error, double expected) { return (found - expected) / error; }

/// The largest weights of a photon's pieces.
struct Weights {
  double largest = 0;
  void piece(const Ray&, double) {}
  void met(std::uint32_t, double, bool) {}
  void tint(const glm::dvec3& now) { largest = std::max({largest, now.r, now.g, now.b}); }
};

}  // namespace

TEST_SUITE("colours") {
  TEST_CASE("in a closed room each band has its own irradiance, π L / (1 - albedo)" * doctest::test_suite("long")) {
    for (const Colours& colours :
         {Colours{.diffuse = {0.8, 0.3, 0.0}, .emitted = {1, 0.25, 3}},
          Colours{.diffuse = {0.7, 0.1, 0.1}, .specular = {0.1, 0.7, 0.2}, .emitted = {0, 1, 1}}}) {
      const Scene scene = coloured_furnace(colours);
      const TracedPaths paths = photon_paths(scene, 400'000, 3);
      const std::vector<Disc> discs = discs_of(scene, 0.1);
      const Outcome found =
          estimate(make_problem(paths, discs, true), {.estimator = Estimator::area_corrected, .mesh = &scene.mesh},
                   {.standard_error = true, .threads = 0});
      REQUIRE(found.bands() == 3);
      for (int band = 0; band < 3; ++band) {
        CAPTURE(band);
        const double albedo = colours.diffuse[band] + colours.specular[band];
        const double expected = std::numbers::pi * colours.emitted[band] / (1 - albedo);
        const BandResults& one = found.band(static_cast<std::size_t>(band));
        double worst = 0;
        double sum = 0;
        for (std::size_t i = 0; i < discs.size(); ++i) {
          sum += one.irradiance[i];
          if (expected > 0)
            worst = std::max(worst, std::abs(deviation(one.irradiance[i], one.standard_error[i], expected)));
        }
        CHECK(sum / static_cast<double>(discs.size()) == doctest::Approx(expected).epsilon(0.02));
        CHECK(worst < 5);
        const BandLedger& light = paths.light.bands[static_cast<std::size_t>(band)];
        CHECK(std::abs(light.deposited + light.left + light.cut - light.emitted) <= 1e-9 * light.emitted);
        CHECK(light.left == 0);
      }
    }
  }

  TEST_CASE("@cornell in colours: each band agrees with backward paths of that band" * doctest::test_suite("long")) {
    const Scene scene = open_scene({.name = "@cornell", .samples = 60, .rgb = true});
    const TracedPaths paths = photon_paths(scene, 600'000, 5);
    const std::vector<Disc> discs = discs_of(scene, 0.03);
    const RunOptions options{.standard_error = true, .threads = 0};
    const Problem problem = make_problem(paths, discs);
    const Outcome photons = estimate(problem, {.estimator = Estimator::area_corrected, .mesh = &scene.mesh}, options);
    const Outcome gathered =
        estimate(problem, {.estimator = Estimator::gather, .scene = &scene, .paths = 2000}, options);
    double means[3]{};
    for (std::size_t band = 0; band < 3; ++band) {
      CAPTURE(band);
      double sum = 0;
      double expected = 0;
      double variance = 0;
      for (std::size_t i = 0; i < discs.size(); ++i) {
        sum += photons.band(band).irradiance[i];
        expected += gathered.band(band).irradiance[i];
        variance +=
            std::pow(photons.band(band).standard_error[i], 2) + std::pow(gathered.band(band).standard_error[i], 2);
      }
      means[band] = expected;
      CHECK(std::abs(sum - expected) < 3 * std::sqrt(variance) + 0.01 * expected);  // bias of the discs' radius
      const BandLedger& light = paths.light.bands[band];
      CHECK(std::abs(light.deposited + light.left + light.cut - light.emitted) <= 1e-9 * light.emitted);
      CHECK(light.left > 0.2 * light.emitted);
    }
    CHECK(means[2] < 0.95 * means[0]);  // both coloured walls are dark in blue
  }

  TEST_CASE("gather in a room that is lit in blue alone: no light in the other bands, hits of the blue one") {
    const Scene scene = coloured_furnace({.diffuse = {0.5, 0.5, 0.5}, .emitted = {0, 0, 2}});
    const std::vector<Disc> discs = discs_of(scene, 0.1);
    const Outcome found = estimate(make_problem_without_rays(discs, 0, true),
                                   {.estimator = Estimator::gather, .scene = &scene, .paths = 64});
    REQUIRE(found.bands() == 3);
    CHECK(std::ranges::count(found.irradiance, 0) == 100);
    CHECK(std::ranges::count(found.further[0].irradiance, 0) == 100);
    CHECK(found.further[1].irradiance[7] > 5);
    CHECK(found.hits[7] > 0);
    CHECK(found.total_hits > 0);
    CHECK_FALSE(found.stopped);
  }

  TEST_CASE("no weight exceeds 1, and without colours all bands have the bytes of one") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}, .rgb = true});
    const PhotonWalk walk(scene, 1);
    Weights weights;
    for (std::uint64_t photon = 0; photon < 3000; ++photon) static_cast<void>(walk.follow(photon, weights));
    CHECK(weights.largest == 1);
    Scene grey = open_scene({.name = "@caustic", .samples = {}});
    const TracedPaths one = photon_paths(grey, 5000, 2);
    grey.rgb = true;
    const TracedPaths three = photon_paths(grey, 5000, 2);
    REQUIRE(three.further.size() == 2 * one.rays.size());
    for (std::size_t i = 0; i < one.rays.size(); ++i) {
      REQUIRE(three.rays[i].power == one.rays[i].power);
      REQUIRE(three.further[2 * i] == one.rays[i].power);
      REQUIRE(three.further[2 * i + 1] == one.rays[i].power);
    }
  }
}
