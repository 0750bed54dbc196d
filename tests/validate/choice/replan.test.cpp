#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/model/techniques/registry.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/choice/plan.hpp"
#include "detp/validate/choice/plan_basis.hpp"
#include "support/same_bytes.hpp"

using namespace detp;
using doctest::Approx;

namespace {

constexpr double first_radius = 0.03;

std::vector<sim::Disc> discs_with(double radius, std::size_t count = 3000) {
  return sim::uniform_discs(sim::Body::cube_faces, 2, count, radius, 3);
}

/// Segments and lines of different powers, all around the cube.
std::vector<sim::Ray> rays_of_pass(std::uint64_t pass, std::size_t count) {
  std::vector<sim::Ray> rays = sim::LineField({{0, 0, 0}, 2}, pass).lines(0, count);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].power = 1 + static_cast<double>(i % 7);
    if (i % 3 == 0) rays[i].length = 2;
  }
  return rays;
}

/// Whether replans find what new plans find, radius after radius.
void check_passes(const validate::PlanOptions& options, const validate::Plan& first) {
  sim::SearchScratch scratch;
  sim::SearchScratch other;
  validate::Plan now = first;
  std::uint64_t pass = 10;
  for (const double radius : {0.03, 0.02, 0.01, 0.001, 0.05, 0.3}) {
    CAPTURE(radius);
    const auto rays = rays_of_pass(pass++, 1500);
    now = replan(now, radius);
    CHECK_FALSE(now.is_built());
    const auto discs = discs_with(radius);
    const auto fresh = validate::plan(discs, rays, options);
    const sim::RunOptions all{.pairs = true, .standard_error = true};
    support::check_same(validate::execute(now, rays, scratch, all), validate::execute(fresh, rays, other, all), all);
    CHECK(now.is_built());
  }
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("replans find the hits, pairs and irradiance of new plans to the last bit") {
    const auto discs = discs_with(first_radius);
    for (const bool front_facing : {false, true})
      for (const double announced : {1.0, 1500.0, 1e7}) {  // brute force and box trees
        CAPTURE(announced);
        const validate::PlanOptions options{.rays = announced, .front_facing = front_facing};
        check_passes(options, validate::plan(discs, rays_of_pass(1, 1500), options));
      }
  }

  TEST_CASE("so do replans of plans by closed forms") {
    const auto discs = discs_with(first_radius);
    const auto rays = rays_of_pass(1, 1500);
    const validate::PlanOptions far{.farthest = 2e12};
    const auto by_forms = validate::plan(discs, rays, far);
    CHECK(by_forms.rigor() == Rigor::estimate);
    check_passes(far, by_forms);
  }

  TEST_CASE("a replan depends on the first plan and on its radius, not on the radii between") {
    const auto discs = discs_with(first_radius);
    const auto first = validate::plan(discs, rays_of_pass(1, 1500));
    const auto direct = replan(first, 0.01, 1e5);
    const auto by_steps = replan(replan(replan(first, 0.02), 0.3, 10), 0.01, 1e5);
    CHECK(direct.candidate() == by_steps.candidate());
    CHECK(direct.predicted_seconds() == by_steps.predicted_seconds());
    CHECK(direct.predicted_error() == by_steps.predicted_error());
  }

  TEST_CASE("the same radius has the same choice, and its time without sorting") {
    const auto discs = discs_with(first_radius);
    const auto rays = rays_of_pass(1, 1500);
    validate::PlanOptions options;
    for (const Technique technique : all_techniques) options.costs[technique].sort = 0;
    const auto first = validate::plan(discs, rays, options);
    const auto same = replan(first, first_radius);
    CHECK(same.candidate() == first.candidate());
    CHECK(same.predicted_seconds() == Approx(first.predicted_seconds()));
    CHECK(same.predicted_error() == Approx(first.predicted_error()));
    CHECK(same.predicted_seconds_again() == Approx(first.predicted_seconds_again()));
    CHECK(same.prepare_seconds() == Approx(first.prepare_seconds()));
    CHECK(same.peak_bytes() == Approx(first.peak_bytes()));
    CHECK(first.prepare_seconds() < first.predicted_seconds());
    CHECK(first.peak_bytes() > 64.0 * 1500);
  }

  TEST_CASE("many threads may execute a replan that is not built") {
    const auto discs = discs_with(first_radius);
    const auto rays = rays_of_pass(1, 500);
    const auto made = replan(validate::plan(discs, rays), 0.02);
    const auto resized = discs_with(0.02);
    const auto all = sim::run(sim::make_problem(rays, resized), {Technique::brute_force, BruteForceParameters{}});
    std::vector<std::vector<double>> found(4);
    std::vector<std::thread> threads;
    for (auto& one : found)
      threads.emplace_back([&made, &rays, &one] {
        sim::SearchScratch scratch;
        one = validate::execute(made, rays, scratch).irradiance;
      });
    for (std::thread& thread : threads) thread.join();
    for (const auto& one : found) CHECK(one == all.irradiance);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("the choice changes with the number of rays and with the radius") {
    const auto discs = discs_with(first_radius);
    const auto first = validate::plan(discs, rays_of_pass(1, 1500), {.rays = 1e5});
    CHECK(first.candidate().technique == Technique::box_tree);
    CHECK(replan(first, first_radius, 1).candidate().technique == Technique::brute_force);
    CHECK(replan(first, 0.003).predicted_seconds() < first.predicted_seconds());
    CHECK(replan(first, 0.12).predicted_seconds() > first.predicted_seconds());
    CHECK(replan(first, first_radius, 1e6).predicted_seconds() > 5 * first.predicted_seconds());
  }

  TEST_CASE("a plan by closed forms keeps its choice for the same radius, extrapolated or not") {
    const auto discs = discs_with(first_radius);  // on faces: most closed forms are extrapolated
    const auto rays = rays_of_pass(1, 1500);
    for (const double number : {10.0, 1e3, 1e5, 1e7})
      for (double factor = 1; factor > 0.01; factor *= 0.7) {  // for some, the cells' spheres are faster, but not twice
        CAPTURE(factor);
        validate::PlanOptions options{.rays = number, .farthest = 2e12};
        for (const auto& term : unit_cost_terms) options.costs[Technique::cell_spheres].*term.cost *= factor;
        const auto first = validate::plan(discs, rays, options);
        REQUIRE(first.rigor() == Rigor::estimate);
        CHECK(replan(first, first_radius).candidate() == first.candidate());
      }
  }
}

TEST_SUITE("bound") {
  TEST_CASE("no closed form falls faster with the radius and the number of rays than replans assume") {
    for (const double samples : {300.0, 1e4, 1e6})
      for (const double radius : {0.002, 0.02})
        for (const double radius_ratio : {0.3, 0.9, 1.2, 4.0})
          for (const double rays_ratio : {0.01, 1.0, 30.0})
            for (const Technique technique : all_techniques) {
              if (!model::has_closed_form(technique)) continue;
              CAPTURE(name(technique));
              Workload before{.rays = 1e5,
                              .samples = samples,
                              .disc_radius = radius,
                              .sphere_radius = 1,
                              .box = {1, 1, 1},
                              .dimension = 2.5};
              Workload after = before;
              after.rays *= rays_ratio;
              after.disc_radius *= radius_ratio;
              const Candidate candidate = default_candidate(technique);
              const CostTable costs;
              const double ratio = model::assess(after, candidate, costs).time.total() /
                                   model::assess(before, candidate, costs).time.total();
              CHECK(ratio >= 0.999 * validate::least_time_ratio(radius_ratio, rays_ratio));
            }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a radius or a number of rays out of range is refused; a stop request ends the building") {
    const auto discs = discs_with(first_radius, 200);
    const auto rays = rays_of_pass(1, 50);
    const auto made = validate::plan(discs, rays, {.rays = 1e6});
    for (const double radius : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-101, 1e101})
      CHECK_THROWS_AS(static_cast<void>(replan(made, radius)), std::invalid_argument);
    for (const double number : {0.0, -1.0, 0.5, std::nan(""), 1e19})
      CHECK_THROWS_AS(static_cast<void>(replan(made, 0.01, number)), std::invalid_argument);
    const auto next = replan(made, 0.01);
    std::stop_source source;
    source.request_stop();
    sim::SearchScratch scratch;
    CHECK_THROWS_AS(validate::execute(next, rays, scratch, {.stop = source.get_token()}), sim::Stopped);
    CHECK_FALSE(next.is_built());
    CHECK_NOTHROW(validate::execute(next, rays, scratch));  // tries again
  }
}
