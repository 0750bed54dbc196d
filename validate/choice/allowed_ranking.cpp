#include "allowed_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "detp/model/rank/extrapolation.hpp"

namespace detp::validate {
namespace {

void move_choice_to_front(const Valid<Workload>& workload, std::vector<model::Ranked>& ranking) {
  const auto cautious_seconds = [&](const model::Ranked& one) {
    const double doubt = doubt_of(workload, one);
    return std::isinf(doubt) ? doubt : one.time.total() * doubt;
  };
  const auto choice = std::min_element(ranking.begin(), ranking.end(), [&](const auto& a, const auto& b) {
    return cautious_seconds(a) < cautious_seconds(b);
  });
  if (choice != ranking.end()) std::rotate(ranking.begin(), choice, choice + 1);
}

}  // namespace

double doubt_of(const Valid<Workload>& workload, const model::Ranked& one) {
  const Technique technique = one.candidate.technique;
  const bool compared = technique == Technique::brute_force || technique == Technique::box_tree;
  if (compared || one.extrapolated.empty()) return 1;
  return model::is_counted_scene(workload) ? closed_form_doubt : std::numeric_limits<double>::infinity();
}

std::vector<model::Ranked> allowed_ranking(const Valid<Workload>& workload, const Valid<CostTable>& costs,
                                           std::span<const Technique> disabled, const model::SearchLimits& limits) {
  std::vector<model::Ranked> ranking = model::rank(workload, costs, limits);
  const auto removed = std::erase_if(ranking, [&](const model::Ranked& one) {
    return std::find(disabled.begin(), disabled.end(), one.candidate.technique) != disabled.end();
  });
  if (removed > 0) {
    for (model::Ranked& one : ranking) {
      if (one.tuned || limits.stop.stop_requested()) continue;
      if (auto best = model::best_of(one.candidate.technique, workload, costs, limits)) one = std::move(*best);
    }
    std::stable_sort(ranking.begin(), ranking.end(),
                     [](const auto& a, const auto& b) { return a.time.total() < b.time.total(); });
  }
  move_choice_to_front(workload, ranking);
  return ranking;
}

}  // namespace detp::validate
