#include "detp/sim/estimate/gather.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <stop_token>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/scene/resample.hpp"

namespace detp::sim {
namespace {

using std::numbers::pi;

/// The square [-1, 1]² at z = 0, white on its front, and a speck far above it.
Scene lit_floor(std::vector<Light> lights) {
  Scene scene;
  scene.name = "floor";
  scene.mesh.positions = {{-1, -1, 0}, {1, -1, 0},      {1, 1, 0},      {-1, 1, 0},
                          {-1, -1, 2}, {-0.999, -1, 2}, {-1, -0.999, 2}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  scene.mesh.materials.all = {{.diffuse = 0.5}};
  scene.lights = std::move(lights);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  return scene;
}

std::vector<Disc> discs_by_area(const Scene& scene, std::size_t count) {
  std::vector<Sample> samples;
  add_by_area(samples, scene.mesh, count, 5);
  std::vector<Disc> discs;
  for (const Sample& sample : samples) discs.push_back({sample.position, sample.normal, 0.1});
  return discs;
}

Outcome gathered(const Scene& scene, std::span<const Disc> discs, std::uint64_t paths, const RunOptions& options = {},
                 bool front_facing = false) {
  return estimate(make_problem_without_rays(discs, 0, front_facing),
                  {.estimator = Estimator::gather, .scene = &scene, .paths = paths, .seed = 3}, options);
}

struct Judged {
  double mean = 0;    ///< over the discs
  double error = 0;   ///< of it, by their spread
  double spread = 0;  ///< root mean square of the discs' errors over the stated ones
};

Judged judged(const Outcome& outcome, double known) {
  Judged all;
  const auto discs = static_cast<double>(outcome.irradiance.size());
  for (const double one : outcome.irradiance) all.mean += one / discs;
  for (std::size_t i = 0; i < outcome.irradiance.size(); ++i) {
    all.error += std::pow((outcome.irradiance[i] - all.mean) / discs, 2);
    REQUIRE(outcome.standard_error[i] < unbounded);
    all.spread += std::pow((outcome.irradiance[i] - known) / outcome.standard_error[i], 2) / discs;
  }
  return {all.mean, std::sqrt(all.error), std::sqrt(all.spread)};
}

}  // namespace

TEST_SUITE("gather") {
  TEST_CASE("the furnace: 2π, with errors as stated; an albedo that is 10 % off is refuted") {
    Scene scene = open_scene({.name = "@furnace", .samples = {}});
    REQUIRE(*scene.known_irradiance == doctest::Approx(2 * pi));
    const std::vector<Disc> discs = discs_by_area(scene, 400);
    const Judged right = judged(gathered(scene, discs, 256, {.standard_error = true}), 2 * pi);
    CHECK(std::abs(right.mean - 2 * pi) < 4 * right.error);
    CHECK(right.error < 0.005 * 2 * pi);
    CHECK(right.spread == doctest::Approx(1).epsilon(0.15));
    scene.mesh.materials.all[0].diffuse = 0.55;
    const Judged wrong = judged(gathered(scene, discs, 256, {.standard_error = true}), 2 * pi);
    CHECK(std::abs(wrong.mean - 2 * pi) > 8 * wrong.error);
  }

  TEST_CASE("light straight from a point has no error; each path that brings it is a hit") {
    const Scene scene = lit_floor({{PointLight{{0.1, 0.05, 2}}, 3}});
    const std::vector<Disc> discs{{{0.1, 0.05, 0}, {0, 0, 1}, 0.1}, {{0.1, 0.05, 0}, {0, 0, -1}, 0.1}};
    for (const std::uint64_t paths : {1, 7, 64, 100, 3000}) {
      CAPTURE(paths);
      const Outcome both = gathered(scene, discs, paths, {.standard_error = true});
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK(both.irradiance[i] == doctest::Approx(3 / (4 * pi) / 4));
        CHECK(both.hits[i] == paths);
        CHECK((both.standard_error[i] < unbounded) == (paths > 1));
        CHECK(both.upper_bound[i] >= both.irradiance[i]);
        CHECK(both.upper_bound[i] < 5 * both.irradiance[i]);
      }
      const Outcome front = gathered(scene, discs, paths, {}, true);
      CHECK(front.hits == std::vector<std::uint64_t>{paths, 0});
      CHECK(front.irradiance[1] == 0);
      CHECK(front.standard_error.empty());
      CHECK(front.total_hits == paths);
    }
  }

  TEST_CASE("where no path brings light there is a bound, by what others bring; without any light none is known") {
    const Disc lit{{0, 0, 0}, {0, 0, 1}, 0.1};
    const Disc unlit{{0, 0, -1}, {0, 0, 1}, 0.1};
    const Scene scene = lit_floor({{PointLight{{0, 0, 2}}, 3}});
    const Outcome some = gathered(scene, std::vector{lit, unlit}, 64, {.standard_error = true});
    CHECK(some.hits[1] == 0);
    CHECK(some.irradiance[1] == 0);
    CHECK(some.standard_error[1] == unbounded);
    CHECK(some.upper_bound[1] == doctest::Approx(some.irradiance[0] * -std::log(0.05) / 64));
    const Outcome none = gathered(scene, std::vector{unlit}, 64, {.standard_error = true});
    CHECK(none.total_hits == 0);
    CHECK(none.upper_bound[0] == unbounded);
  }

  TEST_CASE("paths are those of the reference, and the same bytes on any number of threads" *
            doctest::test_suite("long")) {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    std::vector<Disc> discs = discs_by_area(scene, 70);
    std::vector<Sample> samples;
    for (const Disc& disc : discs) samples.push_back({disc.centre, disc.normal});
    std::vector<PathSums> sums(samples.size());
    add_backward_paths(BackwardPaths(scene, 3), samples, 100, false, sums);
    const Outcome outcome = gathered(scene, discs, 100);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      CHECK(sums[i].paths == 100);
      CHECK(outcome.irradiance[i] == sums[i].irradiance());
    }
    for (const std::uint64_t paths : {100, 2500, 300'000}) {
      if (paths > 10'000) discs.resize(2);
      const Outcome one = gathered(scene, discs, paths, {.standard_error = true});
      const Outcome four = gathered(scene, discs, paths, {.standard_error = true, .threads = 4});
      CHECK(one.irradiance == four.irradiance);
      CHECK(one.standard_error == four.standard_error);
      CHECK(one.upper_bound == four.upper_bound);
      CHECK(one.hits == four.hits);
    }
  }

  TEST_CASE("a stop request leaves whole discs, and says how many; progress ends at 1") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    const std::vector<Disc> discs = discs_by_area(scene, 500);
    std::stop_source source;
    const Outcome stopped =
        gathered(scene, discs, 20, {.standard_error = true, .stop = source.get_token(), .progress = [&](double share) {
                                      if (share > 0.5) source.request_stop();
                                    }});
    CHECK(stopped.stopped);
    CHECK(stopped.progress.unit == "discs");
    CHECK(stopped.progress.of == 500);
    CHECK(stopped.progress.done > 200);
    CHECK(stopped.progress.done < 500);
    CHECK(stopped.standard_error.empty());
    const Outcome whole = gathered(scene, discs, 20);
    for (std::size_t i = 0; i < discs.size(); ++i)
      CHECK(stopped.irradiance[i] == (stopped.done_discs[i] ? whole.irradiance[i] : 0));
    const Outcome before = gathered(scene, discs, 20, {.stop = source.get_token()});
    CHECK(before.stopped);
    CHECK(before.progress.of == 500);
    std::vector<double> shares;
    CHECK_FALSE(gathered(scene, discs, 20, {.progress = [&](double share) { shares.push_back(share); }}).stopped);
    CHECK(shares.size() > 5);
    CHECK(shares.back() == 1);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("gather says what it lacks") {
    const std::vector<Disc> discs{{{0, 0, 0}, {0, 0, 1}, 0.1}};
    const Problem problem = make_problem_without_rays(discs, 0);
    const Scene scene = lit_floor({{PointLight{{0, 0, 2}}, 3}});
    const auto refuses = [&](const Scene* of, std::uint64_t paths, const char* why, const RunOptions& options = {}) {
      CHECK_THROWS_WITH_AS(
          (void)estimate(problem, {.estimator = Estimator::gather, .scene = of, .paths = paths}, options),
          doctest::Contains(why), std::invalid_argument);
    };
    Scene empty;
    empty.name = "empty";
    const Scene dark = lit_floor({});
    const Scene negative = lit_floor({{PointLight{{0, 0, 2}}, -1}});
    const Scene no_surface = lit_floor({{SurfaceLight{}, 1}});
    Totals totals;
    refuses(nullptr, 64, "needs a scene");
    refuses(&empty, 64, "empty has none");
    refuses(&dark, 64, "needs a light");
    refuses(&negative, 64, "flux");
    refuses(&no_surface, 64, "emits");
    refuses(&scene, 0, "number of paths must be 1 to 4294967296 (got 0)");
    refuses(&scene, 1 + (std::uint64_t{1} << 32), "number of paths");
    refuses(&scene, 64, "no pairs", {.pairs = true});
    refuses(&scene, 64, "no totals", {.totals = &totals});
    refuses(&scene, 64, "threads", {.threads = -1});
  }
}

}  // namespace detp::sim
