#include "closed_forms.hpp"

#include <algorithm>
#include <utility>

#include "comparison.hpp"
#include "detp/model/rank/extrapolation.hpp"

namespace detp::validate {

bool can_measure(const Question& question) {
  return question.workload ||
         (question.problem != nullptr && !(question.rays.empty() && question.problem->rays().empty()));
}

Workload evidence(const Question& question, double rays) {
  const auto measured = [&]() -> Workload {
    if (question.workload) return *question.workload;
    const auto discs = static_cast<double>(question.problem->discs().size());
    const auto of = [&](const sim::Problem& problem) {
      if (question.purpose == Purpose::one_search && question.effects.text() == "auto" &&
          !sim::evidence_can_pay(rays, discs))
        return sim::with_inputs_alone(problem, question.stop);
      return sim::observe(problem, question.surface != nullptr ? *question.surface : sim::SurfaceFacts{},
                          question.effects, question.stop, sim::EvidenceEffort::for_search(rays, discs))
          .workload;
    };
    if (!question.problem->rays().empty()) return of(*question.problem);
    sim::Problem with_rays = *question.problem;
    sim::set_rays(with_rays, question.rays, question.threads);
    return of(with_rays);
  };
  Workload found = measured();
  found.rays = rays;
  return found;
}

std::vector<Prediction> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                        std::span<const Technique> disabled, const model::SearchLimits& limits) {
  std::vector<Prediction> ranking = model::rank(workload, costs, limits);
  const auto removed = std::erase_if(ranking, [&](const Prediction& one) {
    return std::find(disabled.begin(), disabled.end(), one.candidate.technique) != disabled.end();
  });
  if (removed > 0)
    for (Prediction& one : ranking) {
      if (one.tuned || limits.stop.stop_requested()) continue;
      if (auto best = model::best_of(one.candidate.technique, workload, costs, limits)) one = std::move(*best);
    }
  put_choice_first(ranking, model::is_counted_scene(workload));
  return ranking;
}

}  // namespace detp::validate
