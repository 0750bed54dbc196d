#include "regret_report.hpp"

#include <fmt/format.h>

#include "detp/model/vocabulary/quoted.hpp"
#include "table.hpp"
#include "text_table.hpp"
#include "workload_options.hpp"

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
using validate::RegretWorkload;
using validate::TierSummary;

constexpr std::size_t shown_worst = 10;

std::string title_of(const RegretWorkload& workload) {
  return fmt::format("{}, {}, {:g} rays{}, radius {:g}%", workload.scene, name(workload.field), workload.rays,
                     workload.samples > 0 ? fmt::format(", {:g} samples", workload.samples) : "",
                     100 * workload.radius);
}

// JSON

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

/// The candidate of a baseline, unless it depends on the workload.
std::optional<Candidate> candidate_of(std::size_t baseline, const BaselineSummary& summary) {
  const validate::Baseline& rule = validate::baselines()[baseline];
  if (rule.by_workload) return std::nullopt;
  return rule.candidates(Workload{})[summary.option];
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

/// The summary for the first number of threads, and in `by_threads` those for all numbers.
Json summary_json(const std::vector<RegretSummary>& summaries) {
  Json json = summary_json(summaries.front());
  json["by_threads"] = Json::array();
  for (const RegretSummary& summary : summaries) json["by_threads"].push_back(summary_json(summary));
  return json;
}

/// `parameters` and `best_parameters` as text.
Json row_json(const RegretRow& row, const ChoiceRow& choice) {
  Json json{{"scene", row.workload.scene},
            {"held_out", row.workload.held_out},
            {"field", name(row.workload.field)},
            {"rays", whole(row.rays)},
            {"samples", whole(row.samples)},
            {"disc_radius", row.disc_radius},
            {"threads", row.threads},
            {"tier", choice.tier},
            {"technique", name(choice.choice.candidate.technique)},
            {"parameters", describe(choice.choice.candidate)},
            {"predicted_seconds", choice.choice.predicted_seconds > 0 ? Json(choice.choice.predicted_seconds) : Json()},
            {"choosing_seconds", choice.choice.choosing_seconds},
            {"seconds", choice.seconds},
            {"abandoned", choice.regret.at_least},
            {"best_technique", name(row.best.technique)},
            {"best_parameters", describe(row.best)},
            {"best_seconds", row.best_seconds},
            {"tried", row.tried},
            {"regret", choice.regret.value},
            {"noise", row.noise}};
  return json;
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

std::vector<Json> rows_of(const RegretResult& regret, const std::vector<RegretSummary>& summaries) {
  std::vector<Json> rows;
  for (const RegretRow& row : regret.rows)
    for (const RegretSummary& summary : summaries)
      for (const ChoiceRow& choice : row.choices) {
        if (row.threads != summary.threads) continue;
        rows.push_back(row_json(row, choice));
        rows.back().update(baseline_cells(row, summary));
        rows.back()["reason"] = choice.reason;
      }
  return rows;
}

std::string to_csv(const std::vector<Json>& rows) {
  Table table(Columns{"scene",
                      "held_out",
                      "field",
                      "rays",
                      "samples",
                      "disc_radius",
                      "threads",
                      "tier",
                      "technique",
                      "parameters",
                      "predicted_seconds",
                      "choosing_seconds",
                      "seconds",
                      "abandoned",
                      "best_technique",
                      "best_parameters",
                      "best_seconds",
                      "tried",
                      "regret",
                      "noise"} +
              baseline_columns() + Columns{"reason"});
  for (const Json& row : rows) table.add(row);
  return table.csv();
}

// Text

std::string number_text(double number, bool at_least) { return fmt::format("{}{:.3g}", at_least ? ">= " : "", number); }

std::vector<TextCell> figure_cells(const Figures& figures) {
  if (figures.rows == 0) return {{}, {}, {}};
  const bool at_least = figures.at_least > 0;
  return {{number_text(figures.geometric_mean, at_least), Style::strong},
          {number_text(figures.p95, at_least)},
          {number_text(figures.worst, at_least)}};
}

std::vector<TextCell> regret_cells(const std::string& what, const std::string& candidate,
                                   const RegretFigures& figures) {
  std::vector<TextCell> cells{{what}, {candidate}};
  for (const Figures& half : {figures.fitted, figures.held_out})
    for (TextCell& cell : figure_cells(half)) cells.push_back(std::move(cell));
  return cells;
}

std::string regret_table(const RegretSummary& summary, const Screen& screen) {
  const std::string fitted = "fitted scenes";
  const std::string held_out = "held-out scenes";
  TextTable table({{.head = "regret of", .align = Align::left},
                   {.head = "candidate", .align = Align::left, .spare = 1},
                   {.head = "mean", .group = fitted},
                   {.head = "p95", .group = fitted},
                   {.head = "worst", .group = fitted},
                   {.head = "mean", .group = held_out},
                   {.head = "p95", .group = held_out},
                   {.head = "worst", .group = held_out}});
  for (const TierSummary& tier : summary.tiers) table.add(regret_cells(tier.tier, "", tier.regret));
  for (std::size_t i = 0; i < summary.baselines.size(); ++i) {
    const auto candidate = candidate_of(i, summary.baselines[i]);
    table.add(regret_cells(std::string(validate::baselines()[i].text), candidate ? title(*candidate) : "",
                           summary.baselines[i].regret));
  }
  return table.text(screen);
}

std::string summary_text(const RegretSummary& summary, const Screen& screen) {
  std::string text = fmt::format("{} thread{}, {} workload{}\n", summary.threads, summary.threads == 1 ? "" : "s",
                                 summary.rows, summary.rows == 1 ? "" : "s");
  if (summary.rows == 0) return text;
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  text += regret_table(summary, screen);
  add(
      fmt::format("noise     the best, timed twice as if it were two candidates: factor {:.3g} in the geometric mean, "
                  "p95 {:.3g}, worst {:.3g}",
                  summary.noise.geometric_mean, summary.noise.p95, summary.noise.worst));
  for (const TierSummary& tier : summary.tiers) {
    if (tier.price.rows > 0)
      add(
          fmt::format("price     {}: choosing and run take {} times the best, in the geometric mean of {} workloads "
                      "whose best takes over {:g} ms",
                      tier.tier, number_text(tier.price.geometric_mean, tier.price.at_least > 0), tier.price.rows,
                      1e3 * validate::shortest_priced_run));
    if (tier.prediction.rows > 0)
      add(fmt::format("predicted {}: the seconds of the choices are off by {:.2g} % in the median, p95 {:.2g} %",
                      tier.tier, 100 * tier.prediction.median_error, 100 * tier.prediction.p95_error));
  }
  return text + "\n";
}

std::string worst_text(const RegretResult& regret, const Screen& screen) {
  const auto places = validate::worst_choices(regret.rows, shown_worst);
  if (places.empty()) return "";
  TextTable table({{.head = "regret"},
                   {.head = "scene", .align = Align::left},
                   {.head = "field", .align = Align::left, .spare = 1},
                   {.head = "rays"},
                   {.head = "discs"},
                   {.head = "radius"},
                   {.head = "threads", .spare = 2},
                   {.head = "tier", .align = Align::left, .spare = 3},
                   {.head = "choice", .align = Align::left},
                   {.head = "best", .align = Align::left},
                   {.head = "reason", .align = Align::left}});
  for (const ChoicePlace& place : places) {
    const RegretRow& row = regret.rows[place.row];
    const ChoiceRow& choice = row.choices[place.choice];
    table.add({{number_text(choice.regret.value, choice.regret.at_least)},
               {escaped(row.workload.scene)},
               {std::string(name(row.workload.field))},
               {fmt::format("{:g}", row.workload.rays)},
               {fmt::format("{:.0f}", row.samples)},
               {fmt::format("{:g}%", 100 * row.workload.radius)},
               {fmt::format("{}", row.threads)},
               {choice.tier},
               {title(choice.choice.candidate)},
               {title(row.best)},
               {choice.reason}});
  }
  return fmt::format("The {} largest regrets\n", places.size()) + table.text(screen);
}

std::string to_text(const RegretResult& regret, const std::vector<RegretSummary>& summaries,
                    const std::vector<std::string>& missing, const Screen& screen) {
  std::string text;
  for (const RegretSummary& summary : summaries) text += summary_text(summary, screen);
  text += worst_text(regret, screen);
  text +=
      legend(screen,
             "regret: seconds of the candidate over seconds of the best of all that were tried. mean: geometric mean. "
             "p95: 95 % of the workloads have at most this. >=: at least; some runs were abandoned and count with "
             "the time after which they were. radius: of the discs, % of the scene's longest side.");
  const auto add = [&](const std::string& line) { text += wrapped(line, screen.text_width(), 10); };
  for (const std::string& why : missing) add(fmt::format("left out  {}", why));
  for (const validate::RegretSkip& skip : regret.skipped)
    add(fmt::format("skipped   {}: {}", title_of(skip.workload), skip.why));
  return text;
}

}  // namespace

Result report_regret(const RegretResult& regret, const std::vector<int>& threads,
                     const std::vector<std::string>& missing, const Screen& screen) {
  std::vector<RegretSummary> summaries;
  for (const int number : threads) summaries.push_back(validate::summarise(regret.rows, number));
  const std::vector<Json> rows = rows_of(regret, summaries);
  Json skipped = Json::array();
  for (const validate::RegretSkip& skip : regret.skipped)
    skipped.push_back({{"workload", title_of(skip.workload)}, {"why", skip.why}});
  Result result;
  result.json = {
      {"rows", rows}, {"summary", summary_json(summaries)}, {"skipped", std::move(skipped)}, {"left_out", missing}};
  result.text = to_text(regret, summaries, missing, screen);
  result.csv = to_csv(rows);
  if (regret.stopped) result.stopped = {regret.done, regret.workloads, "workloads"};
  return result;
}

}  // namespace detp::cli
