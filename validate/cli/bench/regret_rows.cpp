#include "bench_report.hpp"

#include <fmt/format.h>

#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

using validate::BaselineSummary;
using validate::ChoicePlace;
using validate::ChoiceRow;
using validate::Figures;
using validate::RegretFigures;
using validate::RegretResult;
using validate::RegretRow;
using validate::RegretSummary;
using validate::TierSummary;

Json figures_json(const Figures& figures) {
  if (figures.rows == 0)
    return {{"workloads", 0}, {"geometric_mean", nullptr}, {"p95", nullptr}, {"worst", nullptr}, {"at_least", 0}};
  return {{"workloads", figures.rows},
          {"geometric_mean", figures.geometric_mean},
          {"p95", figures.p95},
          {"worst", figures.worst},
          {"at_least", figures.at_least}};
}

/// The figures over all workloads, and those of the halves under `fitted` and `held_out`.
Json figures_json(const RegretFigures& figures) {
  Json json = figures_json(figures.all);
  json["fitted"] = figures_json(figures.fitted);
  json["held_out"] = figures_json(figures.held_out);
  return json;
}

Json regret_json(const RegretSummary& summary) {
  Json json = Json::object();
  for (const TierSummary& tier : summary.tiers) json[tier.tier] = figures_json(tier.regret);
  for (std::size_t i = 0; i < summary.baselines.size(); ++i) {
    Json one = Json::object();
    if (const auto candidate = candidate_of(i, summary.baselines[i])) {
      one["technique"] = name(candidate->technique);
      one["parameters"] = to_json(*candidate);
    }
    one.update(figures_json(summary.baselines[i].regret));
    json[std::string(validate::baselines()[i].name)] = std::move(one);
  }
  return json;
}

Json prediction_json(const validate::PredictionFigures& prediction) {
  if (prediction.rows == 0) return {{"workloads", 0}, {"median_error", nullptr}, {"p95_error", nullptr}};
  return {
      {"workloads", prediction.rows}, {"median_error", prediction.median_error}, {"p95_error", prediction.p95_error}};
}

/// `prediction` and `price` are those of the first tier; those of all tiers are in `tiers`.
Json summary_json(const RegretSummary& summary) {
  Json json{{"threads", summary.threads},
            {"workloads", summary.rows},
            {"regret", regret_json(summary)},
            {"noise", figures_json(summary.noise)}};
  Json tiers = Json::object();
  for (const TierSummary& tier : summary.tiers)
    tiers[tier.tier] = {{"price", figures_json(tier.price)}, {"prediction", prediction_json(tier.prediction)}};
  if (!summary.tiers.empty()) json.update(tiers.front());
  json["tiers"] = std::move(tiers);
  return json;
}

Json row_json(const RegretRow& row, const ChoiceRow& choice) {
  const validate::Chosen& chosen = choice.choice;
  return {{"scene", row.workload.scene},
          {"held_out", row.workload.held_out},
          {"field", name(row.workload.field)},
          {"rays", whole(row.rays)},
          {"samples", whole(row.samples)},
          {"disc_radius", row.disc_radius},
          {"threads", row.threads},
          {"tier", choice.tier},
          {"technique", name(chosen.prediction.candidate.technique)},
          {"parameters", to_json(chosen.prediction.candidate)},
          {"chosen_threads", chosen.prediction.threads},
          {"predicted_seconds", chosen.predicted_seconds() > 0 ? Json(chosen.predicted_seconds()) : Json()},
          {"choosing_seconds", chosen.choosing_seconds},
          {"seconds", choice.seconds},
          {"abandoned", choice.regret.at_least},
          {"best_technique", name(row.best.technique)},
          {"best_parameters", to_json(row.best)},
          {"best_threads", row.best_threads},
          {"best_seconds", row.best_seconds},
          {"tried", row.tried},
          {"regret", choice.regret.value},
          {"noise", row.noise},
          {"reason", choice.reason}};
}

Columns baseline_columns() {
  Columns columns;
  for (const validate::Baseline& baseline : validate::baselines()) {
    columns.push_back(fmt::format("{}_regret", baseline.name));
    columns.push_back(fmt::format("{}_abandoned", baseline.name));
  }
  return columns;
}

/// The regrets of the baselines, each with the candidate that the summary selected; empty if it does not fit in memory.
Json baseline_cells(const RegretRow& row, const RegretSummary& summary) {
  Json cells = Json::object();
  for (std::size_t i = 0; i < row.baselines.size(); ++i)
    if (const auto& regret = row.baselines[i][summary.baselines[i].option]) {
      cells[fmt::format("{}_regret", validate::baselines()[i].name)] = regret->value;
      cells[fmt::format("{}_abandoned", validate::baselines()[i].name)] = regret->at_least;
    }
  return cells;
}

/// Calls add(row, choice, the baselines' cells) for each row and tier.
template <class Add>
void for_each_choice(const RegretResult& regret, const std::vector<RegretSummary>& summaries, const Add& add) {
  for (const RegretRow& row : regret.rows)
    for (const RegretSummary& summary : summaries)
      if (row.threads == summary.threads)
        for (const ChoiceRow& choice : row.choices) add(row, choice, baseline_cells(row, summary));
}

}  // namespace

std::optional<Candidate> candidate_of(std::size_t baseline, const BaselineSummary& summary) {
  const validate::Baseline& rule = validate::baselines()[baseline];
  if (rule.by_workload) return std::nullopt;
  return rule.candidates(Workload{})[summary.option];
}

Json regret_rows_json(const RegretResult& regret, const std::vector<RegretSummary>& summaries) {
  Json rows = Json::array();
  for_each_choice(regret, summaries, [&](const RegretRow& row, const ChoiceRow& choice, const Json& cells) {
    Json json = row_json(row, choice);
    json.update(cells);
    rows.push_back(std::move(json));
  });
  return rows;
}

std::string regret_rows_csv(const RegretResult& regret, const std::vector<RegretSummary>& summaries) {
  Table table(Columns{"scene", "held_out", "field", "rays", "samples", "disc_radius", "threads", "tier"} +
              candidate_columns() +
              Columns{"chosen_threads", "predicted_seconds", "choosing_seconds", "seconds", "abandoned",
                      "best_technique", "best_parameters", "best_threads", "best_seconds", "tried", "regret", "noise"} +
              baseline_columns() + Columns{"reason"});
  for_each_choice(regret, summaries, [&](const RegretRow& row, const ChoiceRow& choice, const Json& cells) {
    Json json = row_json(row, choice);
    json.update(candidate_cells(choice.choice.prediction.candidate));
    json["best_parameters"] = describe(row.best);
    json.update(cells);
    table.add(json);
  });
  return table.csv();
}

Json regret_summary_json(const RegretResult& regret, const std::vector<RegretSummary>& summaries) {
  Json json = summary_json(summaries.front());
  json["by_threads"] = Json::array();
  for (const RegretSummary& summary : summaries) json["by_threads"].push_back(summary_json(summary));
  json["worst"] = Json::array();
  for (const ChoicePlace& place : validate::worst_choices(regret.rows, most_worst_choices)) {
    const RegretRow& row = regret.rows[place.row];
    json["worst"].push_back(row_json(row, row.choices[place.choice]));
  }
  return json;
}

}  // namespace detp::cli
