#include "closed_form_choice.hpp"

#include <algorithm>
#include <utility>

#include "detp/model/rank/extrapolation.hpp"
#include "doubt.hpp"

namespace detp::validate {

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
