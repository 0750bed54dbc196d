#include "detp/validate/choice/pilot.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/technique/searcher.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/choice/choice.hpp"

using namespace detp;
using doctest::Approx;

namespace {

std::vector<sim::Ray> pieces_of_lines(const std::vector<sim::Disc>& discs, std::size_t count, double length) {
  std::vector<sim::Ray> rays = sim::LineField(sim::enclosing_sphere(discs), 4).lines(0, count);
  for (sim::Ray& ray : rays) ray.length = length;
  return rays;
}

struct Bounded {
  Bounded(std::size_t samples, double radius, std::size_t count, double length = sim::Ray{}.length)
      : discs(sim::uniform_discs(sim::Body::cube_faces, 2, samples, radius, 3)),
        rays(pieces_of_lines(discs, count, length)),
        problem(sim::make_problem(rays, discs)) {}

  std::vector<sim::Disc> discs;
  std::vector<sim::Ray> rays;
  sim::Problem problem;
};

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("no box tree visits fewer discs or tests fewer rays, if all discs and rays are tried") {
    for (const double radius : {0.01, 0.1, 0.5})
      for (const double length : {sim::Ray{}.length, 0.7}) {
        const Bounded example(64, radius, 100, length);
        const auto least = validate::least_box_tree_counts(example.problem, example.rays, 100);
        if (radius >= 0.1) CHECK(least.visits > 0);
        CHECK(least.segments == (example.rays.front().is_line() ? 0 : 100));
        for (const int leaf : {1, 4, 16, 64}) {
          const auto counts = sim::run(example.problem, {Technique::box_tree, BoxTreeParameters{8, leaf}}, {}).counts;
          CHECK(least.visits <= static_cast<double>(counts.visits) * (1 + 1e-12));
          CHECK(least.disc_tests <= static_cast<double>(counts.disc_tests) * (1 + 1e-12));
        }
      }
  }
}

TEST_SUITE("known answer") {
  TEST_CASE(
      "where every ray crosses the sphere around every disc, each disc is visited once and tested with every ray") {
    Bounded example(10'000, 2, 300);
    for (sim::Ray& ray : example.rays) ray.origin = {};  // the centre of the cube
    const auto least = validate::least_box_tree_counts(example.problem, example.rays, 300);
    CHECK(least.visits == Approx(10'000));
    CHECK(least.disc_tests == Approx(3e6));
  }

  TEST_CASE(
      "a few rays and large discs: brute force is chosen before the discs are sorted, from the sample alone, too") {
    const CostTable costs = validate::built_in_unit_costs();
    bool decided_by_search = false;
    for (const std::size_t rays : {20UL, 40UL, 60UL, 80UL, 100UL, 120UL, 150UL}) {
      const Bounded large(20'000, 2, rays);
      const double seconds =
          price({.loaded = static_cast<double>(rays), .visits = 2e4, .disc_tests = 2e4 * static_cast<double>(rays)},
                costs, Technique::brute_force)
              .total();
      const double preparing = price({.placements = 2e4, .sorted = 2e4}, costs, Technique::box_tree).total();
      const sim::Problem without_rays = sim::searched_problem(large.discs, {}, false, {});
      const auto found = validate::choose({.problem = &large.problem}, costs);
      const auto by_sample = validate::choose(
          {.problem = &without_rays, .rays = large.rays, .ray_count = static_cast<double>(rays)}, costs);
      CAPTURE(rays);
      CHECK(found.best().candidate == by_sample.best().candidate);
      if (seconds > 1.4 * preparing) continue;
      CHECK(found.best().candidate.technique == Technique::brute_force);
      CHECK(found.discs == nullptr);
      decided_by_search = decided_by_search || seconds > preparing;
    }
    CHECK(decided_by_search);
    const Bounded small(20'000, 0.001, 100);
    CHECK(validate::choose({.problem = &small.problem}, costs).best().candidate.technique == Technique::box_tree);
  }
}
