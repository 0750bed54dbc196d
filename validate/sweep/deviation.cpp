#include "deviation.hpp"

#include <algorithm>
#include <cmath>

namespace detp::validate {
namespace {

bool same_quantity(const DeviationSummary& summary, const Deviation& deviation) {
  return summary.technique == deviation.technique && summary.quantity == deviation.quantity &&
         summary.form == deviation.form;
}

void fill(DeviationSummary& summary, std::span<const Deviation> deviations) {
  std::vector<double> sizes;
  for (const Deviation& deviation : deviations) {
    if (!same_quantity(summary, deviation)) continue;
    if (!(deviation.relative_error() <= summary.goal.worst / 4)) {
      ++summary.noisy;
      continue;
    }
    const double size = std::abs(deviation.relative());
    if (size > summary.goal.worst + 3 * deviation.relative_error()) ++summary.beyond;
    if (sizes.empty() || size > summary.worst) {
      summary.worst = size;
      summary.worst_at = deviation;
    }
    sizes.push_back(size);
  }
  summary.compared = sizes.size();
  if (sizes.empty()) return;
  summary.median = median(sizes);
  summary.p95 = quantile(sizes, 0.95);
}

}  // namespace

Goal goal_of(const Deviation& deviation) {
  if (deviation.quantity == "L_i") return {0.02, 0.02};
  if (deviation.technique == "sphere-cache") return {0.10, 0.04};
  if (deviation.technique == "box-tree")
    return deviation.quantity == "culls" || deviation.quantity == "visits" ? Goal{0.15, 0.05} : Goal{0.12, 0.05};
  return {0.03, 0.03};
}

std::vector<DeviationSummary> summarise(std::span<const Deviation> deviations) {
  std::vector<DeviationSummary> summaries;
  for (const Deviation& deviation : deviations) {
    const auto known = std::find_if(summaries.begin(), summaries.end(),
                                    [&](const DeviationSummary& summary) { return same_quantity(summary, deviation); });
    if (known != summaries.end()) continue;
    summaries.push_back({.technique = deviation.technique,
                         .quantity = deviation.quantity,
                         .form = deviation.form,
                         .goal = goal_of(deviation),
                         .worst_at = {}});
    fill(summaries.back(), deviations);
  }
  return summaries;
}

}  // namespace detp::validate
