#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "detp/sim/effects/observe.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/claims/experiments.hpp"
#include "detp/validate/job/job.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

constexpr std::size_t ray_count = 20'000;

struct Given {
  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  sim::SurfaceFacts surface = {};
};

std::array<double, 4> random_for(std::size_t number, std::uint64_t seed) {
  return sim::uniform4(seed, sim::Stream::tests, number);
}

glm::dvec3 place_in_cube(std::size_t number) {
  const auto u = random_for(number, 7);
  return {2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1};
}

std::vector<sim::Disc> cube_of_discs(double radius) {
  return sim::uniform_discs(sim::Body::cube, 2, 20'000, radius, 3);
}

Given with_lines(std::vector<sim::Disc> discs) {
  auto rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, ray_count);
  return {std::move(discs), std::move(rays)};
}

template <class Ray>
Given with_rays(std::vector<sim::Disc> discs, const Ray& ray) {
  Given given{.discs = std::move(discs), .rays = {}};
  for (std::size_t i = 0; i < ray_count; ++i) given.rays.push_back(ray(i));
  return given;
}

Given built_in(const char* scene, sim::Field field) {
  JobRequest request;
  request.scene = scene;
  request.rays = ray_count;
  request.field = field;
  request.disc_radius = Length{0.0025, true};
  Job job = make_job(request);
  return {std::move(job.discs), std::move(job.rays), job.surface};
}

/// In 40 small cubes.
Given clusters_and_lines() {
  std::vector<sim::Disc> discs = cube_of_discs(0.004);
  for (std::size_t i = 0; i < discs.size(); ++i) discs[i].centre = place_in_cube(i % 40) + 0.05 * discs[i].centre;
  return with_lines(std::move(discs));
}

/// Each a tenth as long as the cube's side.
Given short_segments() {
  return with_rays(cube_of_discs(0.02), [](std::size_t i) {
    const auto u = random_for(i, 8);
    return sim::Ray{place_in_cube(i), sim::uniform_direction(u[0], u[1]), 0.2};
  });
}

Given lines_through_the_centre() {
  return with_rays(cube_of_discs(0.02), [](std::size_t i) {
    const auto u = random_for(i, 8);
    return sim::Ray{{0, 0, 0}, sim::uniform_direction(u[0], u[1])};
  });
}

/// Discs that face up, and lines that are almost vertical.
Given light_from_above() {
  std::vector<sim::Disc> discs = cube_of_discs(0.02);
  for (sim::Disc& disc : discs) disc.normal = {0, 1, 0};
  return with_rays(std::move(discs), [](std::size_t i) {
    const auto u = random_for(i, 8);
    return sim::Ray{place_in_cube(i), glm::normalize(glm::dvec3(u[0] - 0.5, -2, u[1] - 0.5))};
  });
}

/// Five of 20 000 discs are 300 times as far from the centre as the others.
Given a_few_far_discs() {
  std::vector<sim::Disc> discs = cube_of_discs(0.004);
  for (std::size_t i = 0; i < 5; ++i) discs[4000 * i].centre *= 300 / glm::length(discs[4000 * i].centre);
  return with_lines(std::move(discs));
}

/// Closed boxes that stop the rays; six of seven samples lie inside of them, a little below the walls, the others on the walls.
class ClosedBoxes {
 public:
  [[nodiscard]] Given given() const {
    Given given{.discs = {}, .rays = {}};
    for (std::size_t i = 0; i < 20'000; ++i) {
      const auto u = random_for(i, 11);
      const int axis = static_cast<int>(i % 3);
      const double side = i % 2 == 0 ? 1 : -1;
      const double depth = i % 7 == 0 ? 0 : 0.06;
      glm::dvec3 at(0.0);
      at[axis] = side * (half - depth);
      at[(axis + 1) % 3] = half * (2 * u[0] - 1);
      at[(axis + 2) % 3] = half * (2 * u[1] - 1);
      glm::dvec3 normal(0.0);
      normal[axis] = side;
      given.discs.push_back({centre(i / 30 % boxes) + at, normal, 0.01});
    }
    for (std::size_t i = 0; given.rays.size() < ray_count; ++i) {
      const auto u = random_for(i, 12);
      sim::Ray ray{place_in_cube(100'000 + i), sim::uniform_direction(u[0], u[1]), 2};
      for (std::size_t box = 0; box < boxes; ++box) ray.length = std::min(ray.length, entry(ray, centre(box)));
      if (!(ray.length > 0)) continue;
      ray.length += 1e-9;  // through the wall, as photon paths
      given.rays.push_back(ray);
    }
    return given;
  }

 private:
  static constexpr double half = 0.25;
  static constexpr std::size_t boxes = 8;

  static glm::dvec3 centre(std::size_t box) { return 0.85 * place_in_cube(box); }

  /// Where the ray enters the box; 0 if it starts inside, infinite if it misses.
  static double entry(const sim::Ray& ray, const glm::dvec3& middle) {
    double from = 0;
    double to = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (middle[axis] - half - ray.origin[axis]) / ray.direction[axis];
      const double b = (middle[axis] + half - ray.origin[axis]) / ray.direction[axis];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return from < to ? from : HUGE_VAL;
  }
};

sim::Observed seen(const Given& given, const std::string& effects) {
  return sim::observe(sim::make_problem(given.rays, given.discs), given.surface, sim::EffectSelection(effects));
}

/// All effects that the evidence calls for, but one. Fails the test unless it calls for that one.
std::string all_on_but(const Given& given, const std::string& left_out) {
  std::string names;
  bool found = false;
  for (const sim::EffectReport& report : seen(given, "auto").effects) {
    const std::string name = sim::option_name(*report.effect);
    found = found || (report.on && name == left_out);
    if (report.on && !report.effect->is_input && name != left_out) names += (names.empty() ? "" : ",") + name;
  }
  REQUIRE(found);
  return names.empty() ? "none" : names;
}

/// The claim "effects.tests.corrected" or "effects.hits.corrected".
Claim claim_with(const Given& given, const std::string& effects, const std::string& what) {
  Experiment experiment;
  experiment.discs = given.discs;
  experiment.choice = {seen(given, effects).workload, given.rays, effects};
  for (Claim& claim : judge_all(effect_findings(experiment)))
    if (claim.id == "effects." + what + ".corrected") return claim;
  FAIL("there is no claim about ", what);
  return {};
}

/// With the effects that the evidence calls for, the claim agrees; if one is left out, it is refuted.
void check_caught(const Given& given, const std::string& effect, const std::string& what) {
  CAPTURE(effect);
  const Claim with = claim_with(given, "auto", what);
  CAPTURE(with.relative_difference);
  CHECK(with.verdict == Verdict::agrees);
  CHECK(with.control_verdict == Verdict::refuted);
  const Claim without = claim_with(given, all_on_but(given, effect), what);
  CAPTURE(without.relative_difference);
  CHECK(without.verdict == Verdict::refuted);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("surface samples left out where samples lie on surfaces: the claim about tests is refuted" *
            doctest::test_suite("long")) {
    check_caught(built_in("@tree", sim::Field::isotropic), "surface-samples", "tests");
  }

  TEST_CASE("clustered samples left out where samples are in clusters: the claim about tests is refuted") {
    check_caught(clusters_and_lines(), "clustered-samples", "tests");
  }

  TEST_CASE("finite paths left out where rays are short: the claim about hits is refuted") {
    check_caught(short_segments(), "finite-paths", "hits");
  }

  TEST_CASE("uneven rays left out where all rays meet: the claims about tests and hits are refuted") {
    check_caught(lines_through_the_centre(), "uneven-rays", "tests");
    check_caught(lines_through_the_centre(), "uneven-rays", "hits");
  }

  TEST_CASE("directional bias left out where light comes from above: the claim about hits is refuted") {
    check_caught(light_from_above(), "directional-bias", "hits");
  }

  TEST_CASE("occlusion left out where samples lie in closed boxes: the claim about hits is refuted") {
    check_caught(ClosedBoxes().given(), "occlusion", "hits");
  }

  TEST_CASE("clustered samples left out where a few discs are far away: the claim about tests is refuted") {
    check_caught(a_few_far_discs(), "clustered-samples", "tests");
  }

  TEST_CASE("photon paths: with no effects the claim about tests is refuted, with those of the evidence it agrees" *
            doctest::test_suite("long")) {
    const Given given = built_in("@tree", sim::Field::photons);
    CHECK(claim_with(given, "auto", "tests").verdict == Verdict::agrees);
    CHECK(claim_with(given, "none", "tests").verdict == Verdict::refuted);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the claims name the effects, and have the counts of a run with all rays") {
    const Given given = short_segments();
    Experiment experiment;
    experiment.discs = given.discs;
    experiment.choice = {seen(given, "auto").workload, given.rays, "finite paths"};
    const auto findings = effect_findings(experiment);
    REQUIRE(findings.size() == 2);
    const Candidate tree{Technique::box_tree, BoxTreeParameters{8, 16}};
    const auto counts = sim::run(sim::make_problem(given.rays, given.discs), tree).counts;
    CHECK(findings[0].observed.mean == static_cast<double>(counts.cull_tests + counts.disc_tests));
    CHECK(findings[1].observed.mean == static_cast<double>(counts.hits));
    for (const Finding& finding : findings) {
      CHECK(finding.quantity.ends_with("predicted with finite paths"));
      CHECK(finding.lines == ray_count);
    }
  }

  TEST_CASE("without a question, and after a stop request, there are no claims") {
    CHECK(effect_findings(Experiment{}).empty());
    Experiment experiment;
    experiment.discs = cube_of_discs(0.02);
    experiment.choice = {cube_workload(10, 20'000, 0.02, 2), {{.direction = {0, 0, 1}}}};
    std::stop_source source;
    source.request_stop();
    experiment.stop = source.get_token();
    CHECK(effect_findings(experiment).empty());
  }
}
