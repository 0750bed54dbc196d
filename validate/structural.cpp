#include "structural.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "structural_index.hpp"
#include "structural_walk.hpp"

namespace detp::validate {
namespace {

/// The discs as a problem: its one ray only gives it the slack of rays that start in S₀.
class RaylessProblem {
 public:
  explicit RaylessProblem(std::span<const sim::Disc> discs)
      : ray_{.origin = discs.empty() ? glm::dvec3{0} : discs[0].centre},
        problem_(sim::make_problem({&ray_, 1}, discs)) {}

  [[nodiscard]] const sim::Problem& get() const { return problem_; }

 private:
  sim::Ray ray_;
  sim::Problem problem_;
};

/// Rays listed by all builds of each sphere: its builds times the mean length of its list. That length is known at the
/// builds of the next sphere (or, of the innermost, at the discs it serves), where long lists are read more often: up
/// to 4 % too many.
double expected_copies(const ExpectedWalk& walk, double discs) {
  double copies = 0;
  for (std::size_t i = 0; i < walk.spheres.size(); ++i) {
    const bool last = i + 1 == walk.spheres.size();
    const double tests = last ? walk.disc_tests : walk.spheres[i + 1].tests;
    const double readings = last ? discs : walk.spheres[i + 1].rebuilds;
    copies += walk.spheres[i].rebuilds * tests / readings;
  }
  return copies;
}

Counts<double> cache_counts(const sim::Problem& problem, double rays, const SphereCacheParameters& parameters) {
  if (parameters.order != SampleOrder::lebesgue)
    throw std::logic_error(fmt::format(
        "the sphere cache has a structural tier along the Lebesgue curve only (got order {})", name(parameters.order)));
  const ExpectedWalk walk = structural_walk(problem.discs, problem.enclosing, parameters);
  const auto discs = static_cast<double>(problem.discs.size());
  Counts<double> counts{.sphere_tests = rays * walk.sphere_tests,
                        .disc_tests = rays * walk.disc_tests,
                        .copies = rays * expected_copies(walk, discs),
                        .sorted = discs};
  for (const ExpectedSphere& sphere : walk.spheres) counts.rebuilds += sphere.rebuilds;
  return counts;
}

double expected_hits(const sim::Problem& problem, double rays) {
  const double outer = problem.enclosing.radius;
  double hits = 0;
  for (const sim::Disc& disc : problem.discs) hits += 0.5 * (disc.radius / outer) * (disc.radius / outer);
  return rays * hits;
}

Counts<double> technique_counts(const sim::Problem& problem, double rays, const Candidate& candidate) {
  switch (candidate.technique) {
    case Technique::brute_force:
      return {.disc_tests = rays * static_cast<double>(problem.discs.size())};
    case Technique::sphere_cache:
      return cache_counts(problem, rays, std::get<SphereCacheParameters>(candidate.parameters));
    case Technique::octree:
    case Technique::grid:
      return structural_index_counts(problem, rays, candidate);
    default:
      throw std::logic_error(fmt::format("{} has no structural tier", name(candidate.technique)));
  }
}

}  // namespace

Counts<double> structural_counts(std::span<const sim::Disc> discs, double rays, const Candidate& candidate) {
  require_count("number of rays", rays, 1, 1e18);
  check(candidate);
  const RaylessProblem problem(discs);
  Counts<double> counts = technique_counts(problem.get(), rays, candidate);
  counts.hits = expected_hits(problem.get(), rays);
  return counts;
}

}  // namespace detp::validate
