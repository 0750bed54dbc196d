#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "detp/sim/effects/observe.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"

using namespace detp;

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

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE(
      "degenerate rays and discs give finite evidence and a valid workload, with effects by evidence or by hand") {
    for (const Case& one : degenerate_cases()) {
      CAPTURE(one.name);
      for (const char* effects : {"auto", "all", "none"})
        for (const bool front_facing : {false, true}) {
          CAPTURE(effects);
          CAPTURE(front_facing);
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
}
