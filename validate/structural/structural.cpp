#include "structural.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "structural_registry.hpp"

namespace detp::validate {
namespace {

/// The discs as a problem. It has one ray, which is only there to set the slack for rays that start in S₀.
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

double expected_hits(const sim::Problem& problem, double rays) {
  const double outer = problem.enclosing.radius;
  double hits = 0;
  for (const sim::Disc& disc : problem.discs) hits += 0.5 * (disc.radius / outer) * (disc.radius / outer);
  return rays * hits;
}

}  // namespace

Counts<double> structural_brute_force(const sim::Problem& problem, double rays, const Parameters&,
                                      const std::stop_token&) {
  const auto discs = static_cast<double>(problem.discs.size());
  return {.visits = discs * blocks_of(rays, static_cast<double>(problem.discs.size())), .disc_tests = rays * discs};
}

Counts<double> structural_counts(const sim::Problem& problem, double rays, const Valid<Candidate>& candidate,
                                 const std::stop_token& stop, bool front_facing) {
  require_count("number of rays", rays, 1, 1e18);
  const StructuralModel& model = structural_model(candidate.technique);
  if (model.counts == nullptr)
    throw std::invalid_argument(
        fmt::format("{} has no structural counts: {}", name(candidate.technique), model.why_none));
  Counts<double> counts = model.counts(problem, rays, candidate.parameters, stop);
  counts.hits = (front_facing ? 0.5 : 1) * expected_hits(problem, rays);
  return counts;
}

Counts<double> structural_counts(std::span<const sim::Disc> discs, double rays, const Valid<Candidate>& candidate,
                                 const std::stop_token& stop, bool front_facing) {
  return structural_counts(RaylessProblem(discs).get(), rays, candidate, stop, front_facing);
}

}  // namespace detp::validate
