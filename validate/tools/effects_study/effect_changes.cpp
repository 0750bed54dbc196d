#include "effect_changes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detp/validate/statistics/statistics.hpp"

namespace detp::study {
namespace {

std::string median_and_largest(const std::vector<double>& ratios) {
  if (ratios.empty()) return "";
  return fmt::format("{:.2f}, {:.2f}", validate::median(ratios), *std::max_element(ratios.begin(), ratios.end()));
}

}  // namespace

void EffectChanges::add(const sim::EffectReport& report, double tests, double hits, bool choice) {
  Changes& changes = changes_[report.effect];
  Part& part = report.on ? changes.on : changes.off;
  if (tests > 0) part.tests.push_back(std::max(tests, 1 / tests));
  if (hits > 0) part.hits.push_back(std::max(hits, 1 / hits));
  part.choices += choice ? 1 : 0;
  changes.close += report.is_close() ? 1 : 0;
  changes.seconds.push_back(report.seconds);
}

std::string EffectChanges::table() const {
  std::string text =
      "| effect | on | close | tests change, where on | where off | hits change, where on | where off | "
      "choice, where on | where off | evidence, µs |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const sim::Effect* effect : sim::all_effects) {
    const auto found = changes_.find(effect);
    if (found == changes_.end()) continue;
    const auto& [on, off, close, seconds] = found->second;
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} |\n", effect->name, on.tests.size(),
                        close, median_and_largest(on.tests), median_and_largest(off.tests), median_and_largest(on.hits),
                        median_and_largest(off.hits), on.choices, off.choices, 1e6 * validate::median(seconds));
  }
  return text;
}

}  // namespace detp::study
