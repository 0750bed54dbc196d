#include "contenders.hpp"

#include <algorithm>

#include "detp/validate/calibration/built_in_costs.hpp"

namespace detp::validate {
Contenders contenders(const Workload& workload, std::span<const Technique> named, double hopeless) {
  const auto wanted = [&](Technique technique) {
    return named.empty() || std::find(named.begin(), named.end(), technique) != named.end();
  };
  std::vector<Prediction> ranking = model::rank(workload, built_in_unit_costs());
  Contenders found{.candidates = {}, .hits = ranking.front().counts.hits};
  std::erase_if(ranking, [&](const Prediction& ranked) { return !wanted(ranked.candidate.technique); });
  for (const Prediction& ranked : ranking)
    if (ranked.time.total() <= hopeless * ranking.front().time.total()) found.candidates.push_back(ranked.candidate);
  for (const Technique technique : exact_techniques)
    if (wanted(technique) && !model::has_closed_form(technique))
      found.candidates.push_back(default_candidate(technique));
  return found;
}

}  // namespace detp::validate
