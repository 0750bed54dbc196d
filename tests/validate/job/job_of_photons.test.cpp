#include "detp/validate/job/job.hpp"

#include <doctest/doctest.h>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"

using namespace detp;

TEST_SUITE("known answer") {
  TEST_CASE("paths go on through surfaces where the evidence calls for it, and where they are told to") {
    const auto length = [](const char* effects, const char* scene) {
      validate::JobRequest request;
      request.scene = scene;
      request.rays = 5000;
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

  TEST_CASE("the evidence is reported for photon paths, and is 0 for lines and for rays that are given") {
    for (const sim::Field field : {sim::Field::isotropic, sim::Field::photons}) {
      validate::JobRequest request;
      request.scene = "@cornell";
      request.rays = 1000;
      request.field = field;
      const validate::Job job = validate::make_job(request);
      for (const sim::EffectReport& report : job.observed().effects) {
        if (report.effect != &sim::concave_surfaces) continue;
        CHECK(report.on == (field == sim::Field::photons));
        CHECK((report.value > 0.01) == (field == sim::Field::photons));
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
