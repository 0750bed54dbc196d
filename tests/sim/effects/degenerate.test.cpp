#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/effects/far_discs.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/effects/self_shadow.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "detp/sim/scene/vertices.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

using Discs = std::vector<sim::Disc>;
using Rays = std::vector<sim::Ray>;

/// Discs in a cube of side 2 around the origin, changed one by one.
Discs discs_with(const std::function<void(sim::Disc&)>& change, std::size_t count = 3000) {
  Discs discs = sim::uniform_discs(sim::Body::cube, 2, count, 0.01, 1);
  for (sim::Disc& disc : discs) change(disc);
  return discs;
}

Rays lines_through(const Discs& discs) { return sim::LineField(sim::enclosing_sphere(discs), 1).lines(0, 1000); }

Rays rays_with(const Discs& discs, const std::function<void(sim::Ray&)>& change) {
  Rays rays = lines_through(discs);
  for (sim::Ray& ray : rays) change(ray);
  return rays;
}

struct Case {
  std::string name;
  Discs discs;
  Rays rays;
};

std::vector<Case> degenerate_cases() {
  std::vector<Case> cases;
  const auto add_discs = [&](const char* name, const Discs& discs) {
    cases.push_back({fmt::format("{}, lines", name), discs, lines_through(discs)});
    cases.push_back(
        {fmt::format("{}, segments", name), discs, rays_with(discs, [](sim::Ray& ray) { ray.length = 1; })});
  };
  add_discs("all in one point", discs_with([](sim::Disc& disc) { disc.centre = {1, 2, 3}; }));
  add_discs("on a line", discs_with([](sim::Disc& disc) { disc.centre.y = disc.centre.z = 0; }));
  add_discs("on a slanted line", discs_with([](sim::Disc& disc) { disc.centre = glm::dvec3(disc.centre.x); }));
  add_discs("in a plane", discs_with([](sim::Disc& disc) { disc.centre.z = 0; }));
  add_discs("in a plane, facing along it", discs_with([](sim::Disc& disc) {
              disc.centre.z = 0;
              disc.normal = {1, 0, 0};
            }));
  add_discs("one disc", Discs(1));
  add_discs("two discs at a point", Discs(2));
  add_discs("in a cube at 1e6", discs_with([](sim::Disc& disc) { disc.centre = 0.5 * disc.centre + 1e6; }));
  add_discs("far larger than the scene", discs_with([](sim::Disc& disc) { disc.radius = 1e6; }));
  add_discs("of 1e-9 of the scene", discs_with([](sim::Disc& disc) { disc.radius = 1e-9; }));
  add_discs("at 1e90", discs_with([](sim::Disc& disc) {
              disc.centre *= 1e89;
              disc.radius = 1e87;
            }));
  add_discs("at 1e-80", discs_with([](sim::Disc& disc) {
              disc.centre *= 1e-80;
              disc.radius = 1e-82;
            }));
  const Discs cube = discs_with([](sim::Disc&) {});
  cases.push_back({"one line", cube, {lines_through(cube).front()}});
  cases.push_back({"one segment", cube, {{.origin = {0, 0, -1}, .direction = {0, 0, 1}, .length = 2}}});
  cases.push_back({"one ray and one disc", Discs(1), Rays(1)});
  for (const double length : {sim::unbounded, 4.0, 1e-9, 1e99})
    cases.push_back({fmt::format("parallel rays of length {}", length), cube, rays_with(cube, [&](sim::Ray& ray) {
                       ray.direction = {0, 0, 1};
                       ray.length = length;
                     })});
  cases.push_back({"the same ray a thousand times", cube, Rays(1000, {.origin = {0, 0, -2}, .length = 4})});
  cases.push_back({"segments outside the scene", cube, rays_with(cube, [](sim::Ray& ray) {
                     ray.origin += glm::dvec3(1000);
                     ray.length = 1;
                   })});
  cases.push_back({"lines outside the scene", cube, rays_with(cube, [](sim::Ray& ray) {
                     ray.origin = {50, 0, 0};
                     ray.direction = {0, 0, 1};
                   })});
  cases.push_back({"rays in the plane of the discs", discs_with([](sim::Disc& disc) { disc.centre.z = 0; }),
                   rays_with(cube, [](sim::Ray& ray) {
                     ray.origin.z = 0;
                     ray.direction = {1, 0, 0};
                     ray.length = 3;
                   })});
  return cases;
}

void check_finite(const sim::Observed& observed) {
  CHECK_NOTHROW(check(observed.workload));
  for (const sim::EffectReport& report : observed.effects) {
    CAPTURE(report.effect->name);
    CHECK(std::isfinite(report.value));
    CHECK(report.value >= 0);
    CHECK(std::isfinite(report.standard_error));
    CHECK(report.standard_error >= 0);
    CHECK_FALSE(report.reason.empty());
  }
}

sim::Problem problem_of(const std::vector<sim::Disc>& discs) { return sim::make_problem_without_rays(discs, 1000); }

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.name = "test";
  scene.mesh = std::move(mesh);
  scene.samples = samples_at_vertices(scene.mesh, default_crease, scene.notices);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.lights = {{DirectionalLight{{-0.3, -0.8, -0.5}}}};
  return scene;
}

Finding shadow_in(const Scene& scene, bool front_facing = true) {
  return self_shadow(scene, caster_for(scene), front_facing).finding;
}

/// Floor and two walls that meet in a corner, seen from inside.
Mesh corner() {
  Mesh mesh;
  built_in::add_quad(mesh, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}, 0.1);
  built_in::add_quad(mesh, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 0.1);
  built_in::add_quad(mesh, {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}, 0.1);
  return mesh;
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("degenerate rays and discs give finite evidence and a valid workload, whatever effects are on") {
    for (const Case& one : degenerate_cases()) {
      CAPTURE(one.name);
      for (const char* effects : {"auto", "all", "none"})
        for (const bool front_facing : {false, true}) {
          INFO("effects ", effects, ", front_facing ", front_facing);
          const sim::Problem problem = sim::make_problem(one.rays, one.discs, front_facing);
          check_finite(sim::observe(problem, {}, sim::EffectSelection(effects)));
        }
    }
  }

  TEST_CASE("a scene at 1e6 has the evidence of the same scene at the origin") {
    const Discs at_origin = discs_with([](sim::Disc& disc) { disc.centre *= 0.5; });
    const Discs far = discs_with([](sim::Disc& disc) { disc.centre = 0.5 * disc.centre + 1e6; });
    const auto segments = [](const Discs& discs) { return rays_with(discs, [](sim::Ray& ray) { ray.length = 0.5; }); };
    const Rays near = segments(at_origin);
    const sim::Observed a = sim::observe(sim::make_problem(near, at_origin));
    const Rays rays = segments(far);
    const sim::Observed b = sim::observe(sim::make_problem(rays, far));
    for (std::size_t i = 0; i < a.effects.size(); ++i) {
      CAPTURE(a.effects[i].effect->name);
      CHECK(b.effects[i].value == doctest::Approx(a.effects[i].value).epsilon(0.02));
      CHECK(a.effects[i].on == b.effects[i].on);
    }
  }

  TEST_CASE("a stop request ends the search for self shadows") {
    std::stop_source source;
    const Scene scene = scene_of(corner());
    const auto caster = caster_for(scene);
    source.request_stop();
    CHECK_THROWS_AS((void)self_shadow(scene, caster, true, source.get_token()), Stopped);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("discs far outside the central box are counted, the others are near; without them none are far") {
    auto discs = sim::uniform_discs(sim::Body::cube, 2, 10'000, 0.02, 1);
    CHECK_FALSE(find_far_discs(problem_of(discs)));
    discs[10].centre = {0, 500, 0};
    discs[20].centre = {-500, 0, 0};
    const auto found = find_far_discs(problem_of(discs));
    REQUIRE(found);
    CHECK(found->far == 2);
    CHECK(found->reach == doctest::Approx(1.8).epsilon(0.03));  // the central 90 % of a side of 2
    CHECK_FALSE(found->is_near(discs[10]));
    for (std::size_t i = 0; i < 10; ++i) CHECK(found->is_near(discs[i]));
  }

  TEST_CASE("a corner shadows its discs; a box seen from outside does not") {
    const Finding inside = shadow_in(scene_of(corner()));
    CHECK(inside.value > 0.015);
    CHECK(inside.standard_error < 0.003);
    Mesh box;
    built_in::add_box(box, {0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0.1);
    CHECK(shadow_in(scene_of(box)).value == 0.01);
  }

  TEST_CASE("if both faces count, a ball of glass shadows the discs where light arrives inside") {
    Mesh ball;
    ball.materials.all = {{.name = "ball", .diffuse = 0, .glass = 1, .index = 1.5}};
    built_in::add_ball(ball, {0, 0, 0}, 1, 16);
    CHECK(shadow_in(scene_of(ball), false).value > 0.3);
  }

  TEST_CASE("a cloud of small leaves: light through them outweighs shadow") {
    Mesh leaves;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const auto random = uniform4(1, Stream::samples, 2 * i);
      const auto turned = uniform4(1, Stream::samples, 2 * i + 1);
      const glm::dvec3 centre{random[0], random[1], random[2]};
      const glm::dvec3 first = 0.02 * uniform_direction(turned[0], turned[1]);
      const glm::dvec3 second = 0.02 * uniform_direction(turned[2], turned[3]);
      built_in::add_quad(leaves, {{centre, centre + first, centre + first + second, centre + second}}, 0.05);
    }
    CHECK(shadow_in(scene_of(leaves), false).value < -0.01);
  }
}

TEST_SUITE("limit") {
  TEST_CASE("of a few discs none is far, unless their centres are more than four diameters apart") {
    const std::vector<sim::Disc> one{{.radius = 1}};
    CHECK_FALSE(find_far_discs(problem_of(one)));
    std::vector<sim::Disc> two{{.radius = 1}, {.centre = {7, 0, 0}, .radius = 1}};
    CHECK_FALSE(find_far_discs(problem_of(two)));
  }
}
