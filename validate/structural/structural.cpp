#include "structural.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <variant>

#include "detp/sim/base/floating_point.hpp"
#include "structural_parts.hpp"

namespace detp::validate {
namespace {

double expected_hits(const sim::Problem& problem, double rays) {
  const double outer = problem.enclosing().radius;
  double hits = 0;
  for (const sim::Disc& disc : problem.discs()) hits += 0.5 * (disc.radius / outer) * (disc.radius / outer);
  return rays * hits;
}

Counts<double> counts_of(const sim::Problem& problem, const Lines& lines, const BruteForceParameters&,
                         const std::stop_token&) {
  const auto discs = static_cast<double>(problem.discs().size());
  return {.visits = discs * lines.blocks(problem).count(), .disc_tests = lines.rays * discs};
}

}  // namespace

Counts<double> structural_counts(const sim::Problem& problem, double rays, const Valid<Candidate>& candidate,
                                 const std::stop_token& stop, bool front_facing, Engine engine) {
  const sim::DefaultFloatingPoint mode;
  require_count("number of rays", rays, 1, 1e18);
  const auto none = [&](const char* why) {
    return std::invalid_argument(fmt::format("{} has no structural counts: {}", name(candidate.technique), why));
  };
  if (candidate.technique == Technique::sphere_cache_published) throw none("its walk loses rays");
  Counts<double> counts = std::visit(
      [&](const auto& parameters) -> Counts<double> {
        if constexpr (requires { counts_of(problem, Lines{rays, engine}, parameters, stop); })
          return counts_of(problem, Lines{rays, engine}, parameters, stop);
        else
          throw none("it can only be run");
      },
      candidate.parameters);
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
