#include "detp/validate/job/job.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "support/scratch_file.hpp"

using namespace detp;

namespace {

/// Mean irradiance of the discs, over that of the photons that land around the samples.
double over_landings(const std::string& scene, double radius, const char* effects, bool front_facing,
                     bool second_intersection = false) {
  validate::JobRequest request;
  request.scene = scene;
  request.disc_radius = validate::Length{radius, true};
  request.rays = 400'000;
  request.keep_scene = true;
  request.front_facing = front_facing;
  request.second_intersection = second_intersection;
  request.effects = sim::EffectSelection(effects);
  const validate::Job job = validate::make_job(request);
  const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 16}};
  const auto irradiance_of = [&](sim::Estimator estimator) {
    double sum = 0;
    for (const double one :
         sim::estimate(job.problem(), {.estimator = estimator, .candidate = tree, .mesh = &job.scene->mesh}, {})
             .irradiance)
      sum += std::isfinite(one) ? one : 0;
    return sum;
  };
  return irradiance_of(sim::Estimator::disc) / irradiance_of(sim::Estimator::area_corrected);
}

}  // namespace

TEST_SUITE("scenes") {
  TEST_CASE("the bunny's discs have the light that lands around them, and lose a quarter if paths end at surfaces") {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    CHECK(over_landings(folder + "/stanford_bunny.obj", 0.01, "auto", true) == doctest::Approx(1).epsilon(0.05));
    CHECK(over_landings(folder + "/stanford_bunny.obj", 0.01, "none", true) < 0.8);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("light inside of a glass ball reaches its discs, and is lost if paths end at surfaces") {
    CHECK(over_landings("@caustic", 0.0025, "auto", false) == doctest::Approx(1).epsilon(0.1));
    CHECK(over_landings("@caustic", 0.0025, "none", false) < 0.8);
  }

  TEST_CASE("paths to the second intersection, as in the paper, also reach discs behind sheets") {
    CHECK(over_landings("@cornell", 0.01, "none", false, true) > 1.1 * over_landings("@cornell", 0.01, "auto", false));
    validate::JobRequest lines;
    lines.scene = "@cornell";
    lines.field = sim::Field::isotropic;
    lines.second_intersection = true;
    CHECK_THROWS_AS(static_cast<void>(validate::make_job(lines)), std::invalid_argument);
  }

  TEST_CASE("paths go on through surfaces where the evidence calls for it, and where they are told to") {
    const auto length = [](const char* effects, const char* scene) {
      validate::JobRequest request;
      request.scene = scene;
      request.rays = 5000;
      request.front_facing = true;
      request.effects = sim::EffectSelection(effects);
      const validate::Job job = validate::make_job(request);
      double sum = 0;
      for (const sim::Ray& ray : job.rays) sum += ray.length;
      return sum;
    };
    CHECK(length("auto", "@cornell") == length("concave-surfaces", "@cornell"));
    CHECK(length("auto", "@cornell") > length("none", "@cornell"));
    CHECK(length("auto", "@tree-coarse") == length("none", "@tree-coarse"));
    CHECK(length("concave-surfaces", "@tree-coarse") > length("none", "@tree-coarse"));
  }

  TEST_CASE("whether paths go on depends neither on the radius nor on samples and seed") {
    for (const char* scene : {"@cornell", "@tree-coarse"}) {
      std::vector<double> values;
      for (const double radius : {0.002, 0.02, 0.2})
        for (const std::uint64_t seed : {1, 2}) {
          validate::JobRequest request;
          request.scene = scene;
          request.rays = 500;
          request.samples = 100 * static_cast<double>(seed);
          request.disc_radius = {radius, true};
          request.seed = seed;
          values.push_back(validate::make_job(request).surface.self_shadow->value);
        }
      for (const double value : values) CHECK(value == values[0]);
    }
  }

  TEST_CASE("the evidence is reported for photon paths, and is 0 for lines and for rays that are given") {
    for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons}) {
      validate::JobRequest request;
      request.scene = "@cornell";
      request.rays = 1000;
      request.front_facing = true;
      request.field = field;
      const validate::Job job = validate::make_job(request);
      for (const sim::EffectReport& report : job.observed().effects) {
        if (report.effect != &sim::concave_surfaces) continue;
        CHECK(report.on == (field == sim::Field::photons));
        CHECK((report.value > 0) == (field == sim::Field::photons));
      }
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("with the effect off, paths have the bytes of paths that end at surfaces") {
    validate::JobRequest request;
    request.scene = "@cornell";
    request.rays = 3000;
    request.effects = sim::EffectSelection("none");
    const validate::Job job = validate::make_job(request);
    const sim::Scene scene = sim::open_scene({.name = "@cornell", .samples = {}});
    const std::vector<sim::Ray> expected = sim::photon_paths(scene, 3000, 1).rays;
    REQUIRE(job.rays.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CHECK(job.rays[i].origin == expected[i].origin);
      CHECK(job.rays[i].length == expected[i].length);
    }
  }
}
