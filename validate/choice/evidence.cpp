#include "evidence.hpp"

namespace detp::validate {

bool can_measure(const Question& question) {
  return question.workload ||
         (question.problem != nullptr && !(question.rays.empty() && question.problem->rays().empty()));
}

Workload evidence(const Question& question, double rays) {
  const sim::SurfaceFacts surface = question.surface != nullptr ? *question.surface : sim::SurfaceFacts{};
  const auto effort = sim::EvidenceEffort::for_search(
      rays, question.problem != nullptr ? static_cast<double>(question.problem->discs().size()) : 0);
  Workload found;
  if (question.workload) {
    found = *question.workload;
  } else if (question.problem->rays().empty()) {
    sim::Problem with_rays = *question.problem;
    sim::set_rays(with_rays, question.rays, question.threads);
    found = sim::observe(with_rays, surface, question.effects, question.stop, effort).workload;
  } else {
    found = sim::observe(*question.problem, surface, question.effects, question.stop, effort).workload;
  }
  found.rays = rays;
  return found;
}

}  // namespace detp::validate
