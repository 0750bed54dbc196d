#include "detp/validate/choice/workload_class.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "detp/sim/effects/observe.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"
#include "detp/sim/technique/technique.hpp"

using namespace detp;
using validate::class_of;
using validate::WorkloadClass;

TEST_SUITE("identity") {
  TEST_CASE("nearly equal workloads are of one class; each property can change it") {
    const Workload one = cube_workload(100'000, 30'000, 0.01, 1, 2);
    Workload near = one;
    near.rays = 101'000;
    near.samples = 30'100;
    near.disc_radius = 0.0101;
    CHECK(class_of(near) == class_of(one));
    const auto differs = [&](auto&& change) {
      Workload other = one;
      change(other);
      CHECK(class_of(other) != class_of(one));
    };
    differs([](Workload& w) { w.rays *= 2; });
    differs([](Workload& w) { w.samples *= 2; });
    differs([](Workload& w) { w.disc_radius *= 1.5; });
    differs([](Workload& w) { w.dimension = 2.3; });
    differs([](Workload& w) { w.path_length = 0.3; });
    differs([](Workload& w) { w.front_facing = true; });
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the class in words") {
    CHECK(describe(WorkloadClass{.rays = 4, .discs = 5, .spacing = 2, .dimension = 9, .path_length = -1}) ==
          "about 16 rays, 32 discs, X = 2, D = 2.25, mean length 0.5 of the scene's side");
    CHECK(describe(WorkloadClass{.path_length = WorkloadClass::lines, .front_facing = true}) ==
          "about 1 rays, 1 discs, X = 1, D = 0, lines, front facing");
  }

  TEST_CASE("a sampled workload is near the measured one") {
    const auto discs = sim::uniform_discs(sim::Body::cube_faces, 2, 30'000, 0.01, 3);
    auto rays = sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 5000);
    for (sim::Ray& ray : rays) ray.length = 0.5;
    const sim::Problem problem = sim::make_problem(rays, discs);
    const Workload measured = sim::observe(problem).workload;
    const Workload sampled = validate::sampled_workload(problem, rays, 1e6);
    CHECK(sampled.rays == 1e6);
    CHECK(sampled.samples == measured.samples);
    CHECK(sampled.sphere_radius == measured.sphere_radius);
    CHECK(sampled.disc_radius == measured.disc_radius);
    CHECK(sampled.dimension == doctest::Approx(measured.dimension).epsilon(0.1));
    CHECK(sampled.path_length == doctest::Approx(measured.path_length).epsilon(0.1));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("no rays, and a malformed ray") {
    const auto discs = sim::uniform_discs(sim::Body::cube, 2, 100, 0.01, 3);
    const sim::Problem problem = sim::make_problem_without_rays(discs, 10);
    CHECK_THROWS_AS(static_cast<void>(validate::sampled_workload(problem, {}, 1)), std::invalid_argument);
    const std::vector<sim::Ray> bad{{.origin = {0, 0, 0}, .direction = {0, 0, 0}}};
    CHECK_THROWS_AS(static_cast<void>(validate::sampled_workload(problem, bad, 1)), std::invalid_argument);
  }
}
