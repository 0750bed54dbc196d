#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "batches.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/predicates.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "experiments.hpp"

namespace detp::validate {
namespace {

constexpr int positions = 8;  ///< number of spheres or discs of each kind, at random places
constexpr double line_tolerance = 0.015;
constexpr double sphere_radius = 0.4;
constexpr double disc_radius = 0.3;
constexpr int most_levels = 3;
constexpr std::size_t lines_of_each_batch = 100'000;

/// Radius of S_i at the published Q, if r₀ is 1.
double level_radius(int i) { return std::pow(model::published_ratio, static_cast<double>(i)); }

/// A sphere of radius `reach` at a random place inside S₀, which is the unit sphere.
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

struct Bodies {
  std::vector<sim::Sphere> spheres;                          ///< of radius sphere_radius
  std::vector<sim::Disc> discs;                              ///< of radius disc_radius
  std::array<std::vector<sim::Sphere>, most_levels> levels;  ///< S_1, S_2, S_3
};

Bodies bodies_inside(const Experiment& experiment) {
  Bodies bodies{spheres_inside(sphere_radius, batch_seed(experiment, 1, -1)),
                discs_inside(disc_radius, batch_seed(experiment, 2, -1)),
                {}};
  for (int i = 0; i < most_levels; ++i)
    bodies.levels[static_cast<std::size_t>(i)] = spheres_inside(level_radius(i + 1), batch_seed(experiment, 3 + i, -1));
  return bodies;
}

/// Share of one batch's lines that hit a body, averaged over the bodies of each kind.
struct Shares {
  double spheres = 0;
  double discs = 0;
  std::array<double, most_levels> levels{};
};

template <class Body>
double hits_of(const sim::Ray& line, const std::vector<Body>& bodies) {
  return static_cast<double>(
      std::count_if(bodies.begin(), bodies.end(), [&](const Body& body) { return sim::hits(line, body); }));
}

/// All claims use the same lines, because drawing a line takes longer than testing it with a body. So the claims are
/// not independent. The budget for false verdicts holds nevertheless, since it is a sum over the claims.
std::vector<Shares> shares_of_batches(const Experiment& experiment, const Bodies& bodies, std::size_t lines) {
  return for_each_batch(experiment, [&](int batch) {
    const sim::LineField field({}, batch_seed(experiment, 1, batch));
    Shares sum;
    sim::StopCheck check(experiment.stop, "counting");
    for (std::size_t i = 0; i < lines; ++i) {
      check.after(positions * (2 + most_levels));
      const sim::Ray line = field.line(i);
      sum.spheres += hits_of(line, bodies.spheres);
      sum.discs += hits_of(line, bodies.discs);
      for (std::size_t level = 0; level < most_levels; ++level)
        sum.levels[level] += hits_of(line, bodies.levels[level]);
    }
    const auto tests = static_cast<double>(lines * positions);
    sum.spheres /= tests;
    sum.discs /= tests;
    for (double& level : sum.levels) level /= tests;
    return sum;
  });
}

template <class Share>
Estimate estimate_of(const std::vector<Shares>& batches, const Share& share) {
  std::vector<double> shares;
  for (const Shares& batch : batches) shares.push_back(share(batch));
  return batch_means(shares);
}

Finding sphere_finding(const std::vector<Shares>& batches) {
  const double p = model::sphere_hit_probability({sphere_radius}, {1});
  return {.id = "sphere-hit-probability",
          .quantity = "P(line hits a sphere of radius 0.4 r0 inside S0)",
          .predictions = {{Form::published, "eq (3)", p}, {Form::corrected, "eq (3), unchanged", p}},
          .observed = estimate_of(batches, [](const Shares& shares) { return shares.spheres; })};
}

Finding disc_finding(const std::vector<Shares>& batches) {
  return {.id = "disc-hit-probability",
          .quantity = "P(line hits a disc of radius 0.3 r0 inside S0)",
          .predictions = {{Form::corrected, "eq (3) with F = 2 pi d^2, our derivation",
                           model::disc_hit_probability({disc_radius}, {1})}},
          .observed = estimate_of(batches, [](const Shares& shares) { return shares.discs; })};
}

Finding rays_finding(const std::vector<Shares>& batches, double all_rays, int i) {
  Estimate rays =
      estimate_of(batches, [&](const Shares& shares) { return shares.levels[static_cast<std::size_t>(i - 1)]; });
  rays.mean *= all_rays;
  rays.standard_error *= all_rays;
  const double n = model::published::rays_in_sphere(all_rays, {model::published_ratio}, i);
  return {.id = fmt::format("rays-in-sphere-{}", i),
          .quantity = fmt::format("n_{}: rays in S_{} at Q = {}, anywhere inside S0", i, i, model::published_ratio),
          .predictions = {{Form::published, "eq (4)", n}, {Form::corrected, "eq (4), unchanged", n}},
          .observed = rays};
}

}  // namespace

std::vector<Finding> line_hit_findings(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const std::size_t lines = lines_per_batch(experiment, lines_of_each_batch);
  const std::vector<Shares> batches = shares_of_batches(experiment, bodies_inside(experiment), lines);
  if (experiment.stop.stop_requested()) return {};
  std::vector<Finding> findings{sphere_finding(batches), disc_finding(batches)};
  for (int i = 1; i <= most_levels; ++i) findings.push_back(rays_finding(batches, experiment.workload.rays, i));
  for (Finding& finding : findings) {
    finding.batches = batch_count;
    finding.tolerance = line_tolerance;
    finding.lines = lines * batch_count;
    finding.seconds = clock.seconds();
  }
  return findings;
}

double line_hit_work(const Experiment& experiment) {
  return static_cast<double>(lines_per_batch(experiment, lines_of_each_batch) * batch_count * positions *
                             (2 + most_levels));
}

}  // namespace detp::validate
