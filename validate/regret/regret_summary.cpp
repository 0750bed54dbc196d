#include "regret_answer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

using RegretRows = std::vector<const RegretRow*>;
/// The ratio of a row; nullopt if the row has none.
using RatioOf = std::function<std::optional<Regret>(const RegretRow&)>;

/// The figures over the rows whose scene is held out or not; over all: nullopt.
Figures figures_over(const RegretRows& rows, const RatioOf& ratio_of, std::optional<bool> held_out = {}) {
  std::vector<Regret> ratios;
  for (const RegretRow* row : rows)
    if (row->workload.held_out == held_out.value_or(row->workload.held_out))
      if (const auto ratio = ratio_of(*row)) ratios.push_back(*ratio);
  return figures_of(ratios);
}

RegretFigures regret_figures(const RegretRows& rows, const RatioOf& ratio_of) {
  return {figures_over(rows, ratio_of), figures_over(rows, ratio_of, false), figures_over(rows, ratio_of, true)};
}

PredictionFigures prediction_figures(const RegretRows& rows, std::size_t tier) {
  std::vector<double> errors;
  for (const RegretRow* row : rows) {
    const ChoiceRow& one = row->choices[tier];
    if (const auto predicted = one.choice.predicted_seconds(); predicted && !one.regret.at_least)
      errors.push_back(std::abs(*predicted / one.seconds - 1));
  }
  if (errors.empty()) return {};
  return {errors.size(), median(errors), quantile(errors, 0.95)};
}

TierSummary tier_summary(const RegretRows& rows, std::size_t tier) {
  const auto price = [tier](const RegretRow& row) -> std::optional<Regret> {
    const ChoiceRow& one = row.choices[tier];
    if (row.best_seconds < shortest_priced_run) return std::nullopt;
    return Regret{(one.choice.choosing_seconds + one.seconds) / row.best_seconds, one.regret.at_least};
  };
  return {rows.front()->choices[tier].tier,
          regret_figures(rows, [tier](const RegretRow& row) { return row.choices[tier].regret; }),
          figures_over(rows, price), prediction_figures(rows, tier)};
}

RatioOf option_of(std::size_t baseline, std::size_t option) {
  return [baseline, option](const RegretRow& row) { return row.baselines[baseline][option]; };
}

BaselineSummary baseline_summary(const RegretRows& rows, std::size_t baseline) {
  BaselineSummary summary;
  double least = 0;
  for (std::size_t option = 0; option < rows.front()->baselines[baseline].size(); ++option) {
    const Figures fitted = figures_over(rows, option_of(baseline, option), false);
    if (fitted.rows == 0 || (least > 0 && fitted.geometric_mean >= least)) continue;
    least = fitted.geometric_mean;
    summary.option = option;
  }
  summary.regret = regret_figures(rows, option_of(baseline, summary.option));
  return summary;
}

}  // namespace

Figures figures_of(std::span<const Regret> ratios) {
  Figures figures{.rows = ratios.size()};
  if (ratios.empty()) return figures;
  std::vector<double> values;
  double logarithms = 0;
  for (const Regret& ratio : ratios) {
    values.push_back(ratio.value);
    logarithms += std::log(ratio.value);
    if (ratio.at_least) ++figures.at_least;
  }
  figures.geometric_mean = std::exp(logarithms / static_cast<double>(ratios.size()));
  figures.worst = *std::max_element(values.begin(), values.end());
  figures.p95 = quantile(std::move(values), 0.95);
  return figures;
}

std::optional<Candidate> candidate_of(std::size_t baseline, const BaselineSummary& summary) {
  const Baseline& rule = baselines()[baseline];
  if (rule.by_workload) return std::nullopt;
  return rule.candidates(Workload{})[summary.option];
}

RegretSummary summarise(std::span<const RegretRow> rows, int threads) {
  RegretRows of_threads;
  for (const RegretRow& row : rows)
    if (row.threads == threads) of_threads.push_back(&row);
  RegretSummary summary{.threads = threads, .rows = of_threads.size(), .tiers = {}, .baselines = {}, .noise = {}};
  if (of_threads.empty()) return summary;
  for (std::size_t tier = 0; tier < of_threads.front()->choices.size(); ++tier)
    summary.tiers.push_back(tier_summary(of_threads, tier));
  for (std::size_t baseline = 0; baseline < of_threads.front()->baselines.size(); ++baseline)
    summary.baselines.push_back(baseline_summary(of_threads, baseline));
  summary.noise =
      figures_over(of_threads, [](const RegretRow& row) { return Regret{std::max(row.noise, 1 / row.noise)}; });
  return summary;
}

std::vector<TierRow> worst_choices(std::span<const RegretRow> rows, std::size_t most) {
  std::vector<TierRow> worst;
  for (const RegretRow& row : rows)
    for (const ChoiceRow& choice : row.choices)
      if (!row.is_best(choice.choice)) worst.push_back({&row, &choice});
  std::ranges::stable_sort(worst, std::greater(), [](const TierRow& one) { return one.choice->regret.value; });
  worst.resize(std::min(worst.size(), most));
  return worst;
}

}  // namespace detp::validate
