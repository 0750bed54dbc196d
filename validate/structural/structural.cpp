#include "structural.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "structural_registry.hpp"

namespace detp::validate {
namespace {

double expected_hits(const sim::Problem& problem, double rays) {
  const double outer = problem.enclosing().radius;
  double hits = 0;
  for (const sim::Disc& disc : problem.discs()) hits += 0.5 * (disc.radius / outer) * (disc.radius / outer);
  return rays * hits;
}

}  // namespace

Counts<double> structural_brute_force(const sim::Problem& problem, const Lines& lines, const Parameters&,
                                      const std::stop_token&) {
  const auto discs = static_cast<double>(problem.discs().size());
  return {.visits = discs * lines.blocks(problem).count(), .disc_tests = lines.rays * discs};
}

Counts<double> structural_counts(const sim::Problem& problem, double rays, const Valid<Candidate>& candidate,
                                 const std::stop_token& stop, bool front_facing, Engine engine) {
  const sim::DefaultFloatingPoint mode;
  require_count("number of rays", rays, 1, 1e18);
  const StructuralModel model = structural_model(candidate.technique);
  if (model.counts == nullptr)
    throw std::invalid_argument(
        fmt::format("{} has no structural counts: {}", name(candidate.technique), model.why_none));
  Counts<double> counts = model.counts(problem, {rays, engine}, candidate.parameters, stop);
  counts.loaded = rays;
  counts.hits = (front_facing ? 0.5 : 1) * expected_hits(problem, rays);
  return counts;
}

Counts<double> structural_counts(std::span<const sim::Disc> discs, double rays, const Valid<Candidate>& candidate,
                                 const std::stop_token& stop, bool front_facing, Engine engine) {
  const sim::DefaultFloatingPoint mode;
  const sim::Sphere enclosing = sim::enclosing_sphere(discs, stop);
  const double farthest = glm::distance(discs[0].centre, enclosing.centre);  // of ray origins: sets the slack
  return structural_counts(sim::make_problem_without_rays(discs, farthest, false, stop), rays, candidate, stop,
                           front_facing, engine);
}

}  // namespace detp::validate
