#include "allowed_ranking.hpp"

#include <algorithm>
#include <utility>

namespace detp::validate {

std::vector<model::Ranked> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                           std::span<const Technique> disabled, const model::SearchLimits& limits) {
  std::vector<model::Ranked> ranking = model::rank(workload, costs, limits);
  const auto removed = std::erase_if(ranking, [&](const model::Ranked& one) {
    return std::find(disabled.begin(), disabled.end(), one.candidate.technique) != disabled.end();
  });
  if (removed == 0) return ranking;
  for (model::Ranked& one : ranking) {
    if (one.tuned || limits.stop.stop_requested()) continue;
    if (auto best = model::best_of(one.candidate.technique, workload, costs, limits)) one = std::move(*best);
  }
  std::stable_sort(ranking.begin(), ranking.end(),
                   [](const auto& a, const auto& b) { return a.time.total() < b.time.total(); });
  return ranking;
}

}  // namespace detp::validate
