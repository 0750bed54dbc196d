#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "batches.hpp"
#include "detp/model/best_ratio.hpp"
#include "detp/model/line_measure.hpp"
#include "detp/model/sphere_cache_published.hpp"
#include "detp/sim/directions.hpp"
#include "detp/sim/line_field.hpp"
#include "detp/sim/predicates.hpp"
#include "detp/sim/random.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

using model::Form;

constexpr std::size_t lines_per_batch = 100'000;
constexpr std::uint64_t all_lines = lines_per_batch * batch_count;
constexpr int positions = 8;  ///< spheres or discs of each kind, at random places
constexpr double tolerance = 0.015;
constexpr std::int64_t most_levels = 3;

/// A body of that reach, at a random place inside S₀ = unit sphere.
sim::Sphere place_inside(double reach, std::uint64_t seed, int number) {
  const auto u = sim::uniform4(seed, sim::Stream::tests, static_cast<std::uint64_t>(number));
  return {(1 - reach) * std::cbrt(u[0]) * sim::uniform_direction(u[1], u[2]), reach};
}

std::vector<sim::Sphere> spheres_inside(double radius, std::uint64_t seed) {
  std::vector<sim::Sphere> spheres;
  for (int i = 0; i < positions; ++i) spheres.push_back(place_inside(radius, seed, i));
  return spheres;
}

std::vector<sim::Disc> discs_inside(double radius, std::uint64_t seed) {
  std::vector<sim::Disc> discs;
  for (int i = 0; i < positions; ++i) {
    const auto turn = sim::uniform4(seed, sim::Stream::tests, static_cast<std::uint64_t>(i), 1);
    discs.push_back({place_inside(radius, seed, i).centre, sim::uniform_direction(turn[0], turn[1]), radius});
  }
  return discs;
}

/// Share of the lines that hit, averaged over the bodies: one number a batch.
template <class Body>
Estimate hit_share(const Experiment& experiment, const std::vector<Body>& bodies, int part) {
  const auto shares = for_each_batch(experiment, [&](int batch) {
    const sim::LineField field({}, batch_seed(experiment, part, batch));
    std::uint64_t hit = 0;
    sim::StopCheck check(experiment.stop, "counting");
    for (std::size_t i = 0; i < lines_per_batch; ++i) {
      check.after(positions);
      const sim::Ray line = field.line(i);
      for (const Body& body : bodies) hit += sim::hits(line, body) ? 1 : 0;
    }
    return static_cast<double>(hit) / (lines_per_batch * positions);
  });
  return batch_means(shares);
}

Finding sphere_finding(const Experiment& experiment) {
  constexpr double radius = 0.4;
  const Clock clock;
  const Estimate share = hit_share(experiment, spheres_inside(radius, batch_seed(experiment, 1, -1)), 1);
  const double p = model::sphere_hit_probability({radius}, {1});
  return {.id = "sphere-hit-probability",
          .quantity = "P(line hits a sphere of radius 0.4 r0 inside S0)",
          .predictions = {{Form::published, "eq (3)", p}, {Form::corrected, "eq (3), unchanged", p}},
          .observed = share,
          .batches = batch_count,
          .tolerance = tolerance,
          .lines = all_lines,
          .seconds = clock.seconds()};
}

Finding disc_finding(const Experiment& experiment) {
  constexpr double radius = 0.3;
  const Clock clock;
  const Estimate share = hit_share(experiment, discs_inside(radius, batch_seed(experiment, 2, -1)), 2);
  return {.id = "disc-hit-probability",
          .quantity = "P(line hits a disc of radius 0.3 r0 inside S0)",
          .predictions = {{Form::corrected, "eq (3) with F = 2 pi d^2, our derivation",
                           model::disc_hit_probability({radius}, {1})}},
          .observed = share,
          .batches = batch_count,
          .tolerance = tolerance,
          .lines = all_lines,
          .seconds = clock.seconds()};
}

Finding rays_finding(const Experiment& experiment, std::int64_t i) {
  const Clock clock;
  const double radius = std::pow(model::published_ratio, static_cast<double>(i));
  const int part = 2 + static_cast<int>(i);
  Estimate rays = hit_share(experiment, spheres_inside(radius, batch_seed(experiment, part, -1)), part);
  rays.mean *= experiment.workload.rays;
  rays.standard_error *= experiment.workload.rays;
  const double n = model::published::rays_in_sphere(experiment.workload.rays, {model::published_ratio}, i);
  return {.id = fmt::format("rays-in-sphere-{}", i),
          .quantity = fmt::format("n_{}: rays in S_{} at Q = {}, anywhere inside S0", i, i, model::published_ratio),
          .predictions = {{Form::published, "eq (4)", n}, {Form::corrected, "eq (4), unchanged", n}},
          .observed = rays,
          .batches = batch_count,
          .tolerance = tolerance,
          .lines = all_lines,
          .seconds = clock.seconds()};
}

}  // namespace

std::vector<Finding> line_hit_findings(const Experiment& experiment) {
  std::vector<Finding> findings{sphere_finding(experiment), disc_finding(experiment)};
  for (std::int64_t i = 1; i <= most_levels; ++i) findings.push_back(rays_finding(experiment, i));
  if (experiment.stop.stop_requested()) return {};
  return findings;
}

}  // namespace detp::validate
