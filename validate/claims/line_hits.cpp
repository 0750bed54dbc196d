#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "batches.hpp"
#include "detp/model/lines/line_measure.hpp"
#include "detp/model/optimum/best_ratio.hpp"
#include "detp/model/sphere_cache/sphere_cache_published.hpp"
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

/// Bodies of one kind, and the claim about the share of lines that hit one.
struct Bodies {
  Finding finding;
  std::vector<sim::Sphere> spheres = {};
  std::vector<sim::Disc> discs = {};
  double lines = 1;  ///< of which the claim is: 1 for a share

  [[nodiscard]] double hits_of(const sim::Ray& line) const {
    const auto hit = [&](const auto& body) { return sim::hits(line, body); };
    return static_cast<double>(std::ranges::count_if(spheres, hit) + std::ranges::count_if(discs, hit));
  }
};

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

std::vector<FormulaValue> unchanged(const std::string& source, double value) {
  return {{Form::published, source, value}, {Form::corrected, source + ", unchanged", value}};
}

std::vector<Bodies> bodies_inside(const Experiment& experiment) {
  std::vector<Bodies> all;
  all.push_back({.finding = {.id = "sphere-hit-probability",
                             .quantity = "P(line hits a sphere of radius 0.4 r0 inside S0)",
                             .predictions = unchanged("eq (3)", model::sphere_hit_probability({sphere_radius}, {1}))},
                 .spheres = spheres_inside(sphere_radius, batch_seed(experiment, 1, -1))});
  all.push_back({.finding = {.id = "disc-hit-probability",
                             .quantity = "P(line hits a disc of radius 0.3 r0 inside S0)",
                             .predictions = {{Form::corrected, "eq (3) with F = 2 pi d^2, our derivation",
                                              model::disc_hit_probability({disc_radius}, {1})}}},
                 .discs = discs_inside(disc_radius, batch_seed(experiment, 2, -1))});
  const double rays = experiment.workload.rays;
  for (int i = 1; i <= most_levels; ++i)
    all.push_back({.finding = {.id = fmt::format("rays-in-sphere-{}", i),
                               .quantity = fmt::format("n_{}: rays in S_{} at Q = {}, anywhere inside S0", i, i,
                                                       model::published_ratio),
                               .predictions = unchanged(
                                   "eq (4)", model::published::rays_in_sphere(rays, {model::published_ratio}, i))},
                   .spheres = spheres_inside(level_radius(i), batch_seed(experiment, 2 + i, -1)),
                   .lines = rays});
  return all;
}

}  // namespace

/// All claims use the same lines, because drawing a line takes longer than testing it with a body. So the claims are
/// not independent. The budget for false verdicts holds nevertheless, since it is a sum over the claims.
std::vector<Finding> line_hit_findings(const Experiment& experiment) {
  const sim::Stopwatch clock;
  const std::size_t lines = lines_per_batch(experiment, lines_of_each_batch);
  const std::vector<Bodies> bodies = bodies_inside(experiment);
  const auto shares = for_each_batch(experiment, [&](int batch) {
    const sim::LineField field({}, batch_seed(experiment, 1, batch));
    std::vector<double> sums(bodies.size());
    sim::StopCheck check(experiment.stop, "counting");
    for (std::size_t i = 0; i < lines; ++i) {
      check.after(positions * (2 + most_levels));
      const sim::Ray line = field.line(i);
      for (std::size_t kind = 0; kind < sums.size(); ++kind) sums[kind] += bodies[kind].hits_of(line);
    }
    for (double& sum : sums) sum /= static_cast<double>(lines * positions);
    return sums;
  });
  if (experiment.stop.stop_requested()) return {};
  std::vector<Finding> findings;
  for (std::size_t kind = 0; kind < bodies.size(); ++kind) {
    Finding& finding = findings.emplace_back(bodies[kind].finding);
    finding.observed = mean_of(shares, kind);
    finding.observed.mean *= bodies[kind].lines;
    finding.observed.standard_error *= bodies[kind].lines;
  }
  return completed(std::move(findings), {.tolerance = line_tolerance, .lines = lines, .clock = clock});
}

double line_hit_work(const Experiment& experiment) {
  return static_cast<double>(lines_per_batch(experiment, lines_of_each_batch) * batch_count * positions *
                             (2 + most_levels));
}

}  // namespace detp::validate
