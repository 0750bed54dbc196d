#include "agreement.hpp"

#include <algorithm>
#include <cmath>

namespace detp::validate {

CellVerdict verdict_of(const MapCell& cell) {
  const Analysed& choice = cell.analysis->candidates.front();
  const Analysed& best = cell.analysis->candidates[cell.analysis->best.value()];
  return {.agrees = choice.candidate.technique == best.candidate.technique,
          .slower = cell.analysis->regret.value(),
          .within_noise = choice.seconds.value() - choice.spread <= best.seconds.value() + best.spread};
}

std::size_t Agreement::within_noise() const {
  return static_cast<std::size_t>(std::count_if(disagreeing.begin(), disagreeing.end(),
                                                [](const Disagreement& one) { return one.verdict.within_noise; }));
}

Agreement agreement_of(const TechniqueMap& map) {
  Agreement found;
  double logarithms = 0;
  for (const MapRow& row : map.rows)
    for (const MapCell& cell : row.cells) {
      if (!cell.analysis) continue;
      const CellVerdict verdict = verdict_of(cell);
      ++found.cells;
      found.agree += verdict.agrees ? 1 : 0;
      logarithms += std::log1p(verdict.slower);
      found.worst_slowdown = std::max(found.worst_slowdown, 1 + verdict.slower);
      if (!verdict.agrees) found.disagreeing.push_back({&row, &cell, verdict});
    }
  if (found.cells > 0) found.mean_slowdown = std::exp(logarithms / static_cast<double>(found.cells));
  std::stable_sort(found.disagreeing.begin(), found.disagreeing.end(),
                   [](const Disagreement& a, const Disagreement& b) { return a.verdict.slower > b.verdict.slower; });
  return found;
}

}  // namespace detp::validate
