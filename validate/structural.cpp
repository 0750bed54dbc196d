#include "structural.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "structural_hierarchy.hpp"
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

Counts<double> cache_counts(const sim::Problem& problem, double rays, const SphereCacheParameters& parameters,
                            const std::stop_token& stop) {
  if (parameters.order != SampleOrder::lebesgue)
    throw std::invalid_argument(fmt::format(
        "the sphere cache has a structural tier along the Lebesgue curve only (got order {})", name(parameters.order)));
  const ExpectedWalk walk = structural_walk(problem.discs, problem.enclosing, parameters, stop);
  Counts<double> counts{.sphere_tests = rays * walk.sphere_tests,
                        .disc_tests = rays * walk.disc_tests,
                        .sorted = static_cast<double>(problem.discs.size())};
  for (const ExpectedSphere& sphere : walk.spheres) {
    counts.rebuilds += sphere.rebuilds;
    counts.copies += rays * sphere.listed;
  }
  return counts;
}

double expected_hits(const sim::Problem& problem, double rays) {
  const double outer = problem.enclosing.radius;
  double hits = 0;
  for (const sim::Disc& disc : problem.discs) hits += 0.5 * (disc.radius / outer) * (disc.radius / outer);
  return rays * hits;
}

Counts<double> technique_counts(const sim::Problem& problem, double rays, const Candidate& candidate,
                                const std::stop_token& stop) {
  switch (candidate.technique) {
    case Technique::brute_force:
      return {.disc_tests = rays * static_cast<double>(problem.discs.size())};
    case Technique::sphere_cache:
      return cache_counts(problem, rays, std::get<SphereCacheParameters>(candidate.parameters), stop);
    case Technique::cell_spheres:
    case Technique::sphere_tree:
      return structural_hierarchy_counts(problem, rays, candidate, stop);
    case Technique::octree:
    case Technique::grid:
    case Technique::bsp:
      return structural_index_counts(problem, rays, candidate, stop);
    case Technique::sphere_cache_published:
      throw std::invalid_argument("sphere-cache-published has no structural tier: its walk loses rays");
    case Technique::bvh:
    case Technique::photon_map:
      throw std::invalid_argument(
          fmt::format("{} has no structural tier; it can only be run", name(candidate.technique)));
  }
  throw std::logic_error("a technique without a structural tier");
}

}  // namespace

Counts<double> structural_counts(std::span<const sim::Disc> discs, double rays, const Candidate& candidate,
                                 const std::stop_token& stop, bool front_facing) {
  require_count("number of rays", rays, 1, 1e18);
  check(candidate);
  const RaylessProblem problem(discs);
  Counts<double> counts = technique_counts(problem.get(), rays, candidate, stop);
  counts.hits = (front_facing ? 0.5 : 1) * expected_hits(problem.get(), rays);
  return counts;
}

}  // namespace detp::validate
