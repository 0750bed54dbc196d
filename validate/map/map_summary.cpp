#include "map_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/model/vocabulary/quoted.hpp"

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

std::string radius_label(const Length& radius) {
  return radius.relative ? fmt::format("{:.3g} %", 100 * radius.value) : fmt::format("{:.3g}", radius.value);
}

std::string describe(const TechniqueMap& map) {
  const Workload& workload = map.rows.front().workload;
  return fmt::format("{}: {} discs of dimension D = {:.2f}, {}", shown_path(map.name), workload.samples,
                     workload.dimension,
                     map.field == sim::Field::mixed       ? "a mixed field"
                     : map.field == sim::Field::isotropic ? "isotropic lines"
                                                          : "photon paths");
}

}  // namespace detp::validate
