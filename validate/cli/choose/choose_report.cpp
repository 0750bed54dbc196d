#include "choose_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "choose_parts.hpp"
#include "detp/validate/cli/report/answer_rows.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/prediction_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

/// What a pilot predicted of the row, with its errors; null if a pilot did not predict it.
const Prediction* piloted(const ChooseAnswer& answer, const ChooseRow& row) {
  if (!answer.by_sample()) return nullptr;
  for (const Prediction& one : answer.choice.candidates)
    if (one.candidate == row.candidate) return &one;
  return nullptr;
}

std::string why_not(const ChooseAnswer& answer, const ChooseRow& row) {
  if (row.run != nullptr && answer.analysis->best) {
    const double fastest = *answer.analysis->candidates[*answer.analysis->best].seconds;
    if (row.run->seconds) return fmt::format("measured {:.3g}x slower", *row.run->seconds / fastest);
    if (row.run->given_up_after)
      return fmt::format("took over {:.3g}x as long and was given up", *row.run->given_up_after / fastest);
  }
  if (row.predicted == nullptr) return "not measured, and it has no closed form";
  const CostBreakdown& time = row.predicted->time;
  if (time.total() < answer.choice.best().time.total())
    return "predicted faster, but within the error of closed forms or unit costs";
  return fmt::format("predicted {:.3g}x slower, mostly {}", time.total() / answer.choice.best().time.total(),
                     largest_part(time));
}

Json candidate_json(const ChooseAnswer& answer, const ChooseRow& row) {
  Json json{{"technique", name(row.candidate.technique)},
            {"parameters", to_json(row.candidate)},
            {"threads", threads_of(row)}};
  if (row.predicted != nullptr) {
    json["predicted"] = to_json(row.predicted->counts);
    json["predicted_seconds"] = row.predicted->time.total();
    json["predicted_seconds_again"] = row.predicted->time.again();
    json["tuned"] = row.predicted->tuned;
    json.update(extrapolated_json(row.predicted->extrapolated));
    if (const auto error = error_of(answer, row)) {
      json["predicted_seconds_error"] = *error;
      if (piloted(answer, row)->source != Source::closed_form)
        json["predicted_error"] = to_json(piloted(answer, row)->counts_error);
      json["could_still_win"] = could_win(answer, row);
    }
  }
  if (!row.chosen) json["why_not"] = why_not(answer, row);
  if (row.run != nullptr) add_measured(json, *answer.analysis, *row.run);
  return json;
}

Json choice_json(const ChooseAnswer& answer, const ChooseRow& row) {
  Json json{{"technique", name(row.candidate.technique)},
            {"parameters", to_json(row.candidate)},
            {"threads", threads_of(row)}};
  if (row.predicted != nullptr) {
    json["predicted_seconds"] = row.predicted->time.total();
    json["predicted_seconds_again"] = row.predicted->time.again();
    if (const auto error = error_of(answer, row)) json["predicted_seconds_error"] = *error;
    json.update(extrapolated_json(row.predicted->extrapolated));
  }
  if (row.run != nullptr && row.run->seconds) {
    json["measured_seconds"] = *row.run->seconds;
    json["measured_spread"] = row.run->spread;
  }
  return json;
}

/// Why techniques that are not among the candidates were not considered.
void add_left_out(Json& json, const validate::Choice& choice) {
  json["ruled_out"] = Json::array();
  for (const validate::RuledOut& one : choice.ruled_out)
    json["ruled_out"].push_back(
        {{"technique", name(one.technique)}, {one.by_bound ? "at_least_seconds" : "predicted_seconds", one.seconds}});
  json["not_examined"] = names_json(choice.unexamined);
}

Json cells_of(const Prediction& ranked) {
  Json cells = candidate_cells(ranked.candidate);
  cells["threads"] = ranked.threads;
  cells.update(count_cells(ranked.counts, "predicted_"));
  cells["predicted_seconds"] = ranked.time.total();
  cells["predicted_seconds_again"] = ranked.time.again();
  cells["extrapolated"] = !ranked.extrapolated.empty();
  cells["extrapolated_because"] = joined(ranked.extrapolated);
  return cells;
}

/// The cells of a row. `json` is its member of `candidates`.
Json cells_of(const ChooseAnswer& answer, const ChooseRow& row, const Json& json) {
  Json cells = row.predicted != nullptr ? cells_of(*row.predicted) : candidate_cells(row.candidate);
  for (const char* name : {"threads", "predicted_seconds_error", "could_still_win", "measured_seconds",
                           "measured_spread", "given_up_after_seconds", "not_run", "why_not"})
    if (json.contains(name)) cells[name] = json[name];
  if (const Prediction* const one = piloted(answer, row); one != nullptr && one->source != Source::closed_form)
    cells.update(count_cells(one->counts_error, "predicted_error_"));
  if (row.run == nullptr) return cells;
  if (row.run->counted) cells.update(count_cells(*row.run->counted, "counted_"));
  cells.update(missed_ratios(*row.run, answer.costs));
  return cells;
}

const char* role_of(const ChooseAnswer& answer, const ChooseRow& row, bool first) {
  if (row.chosen) return "choice";
  return first && answer.analysis ? "predicted choice" : "candidate";
}

}  // namespace

int threads_of(const ChooseRow& row) { return row.run != nullptr ? row.run->threads : row.predicted->threads; }

std::vector<ChooseRow> rows_of(const ChooseAnswer& answer) {
  std::vector<ChooseRow> rows;
  if (!answer.analysis) {
    for (const Prediction& ranked : answer.choice.candidates) rows.push_back({ranked.candidate, &ranked});
    rows.front().chosen = true;
    return rows;
  }
  for (const validate::Analysed& run : answer.analysis->candidates)
    rows.push_back({run.candidate, run.predicted ? &*run.predicted : nullptr, &run});
  rows[answer.analysis->best.value_or(0)].chosen = true;
  return rows;
}

std::optional<double> error_of(const ChooseAnswer& answer, const ChooseRow& row) {
  const Prediction* const one = piloted(answer, row);
  return one == nullptr ? std::nullopt : std::optional(one->error);
}

bool could_win(const ChooseAnswer& answer, const ChooseRow& row) {
  return row.predicted->time.total() < (1 + validate::distinguishable) * answer.choice.best().time.total();
}

std::string largest_part(const CostBreakdown& time) {
  const std::array<std::pair<double, const char*>, 7> parts{{{time.order, "sorting samples"},
                                                             {time.build, "building the index"},
                                                             {time.rebuild, "ray-sphere tests"},
                                                             {time.copy, "copying lists"},
                                                             {time.traverse, "stepping through the index"},
                                                             {time.intersect, "ray-disc tests"},
                                                             {time.touch, "touching new memory"}}};
  return std::max_element(parts.begin(), parts.end())->second;
}

Json to_json(const ChooseAnswer& answer) {
  const std::vector<ChooseRow> rows = rows_of(answer);
  const ChooseRow& chosen = *std::find_if(rows.begin(), rows.end(), [](const ChooseRow& row) { return row.chosen; });
  Json json{{"choice", choice_json(answer, chosen)},
            {"candidates", Json::array()},
            {"paper_rule",
             {{"technique", name(answer.paper.candidate.technique)},
              {"parameters", to_json(answer.paper.candidate)},
              {"threads", answer.paper.threads},
              {"predicted_seconds", answer.paper.time.total()}}},
            {"effects", to_json(answer.effects)},
            {"rigor", name(answer.rigor)},
            {"engine", name(answer.costs.engine)},
            {"unit_costs", answer.costs_origin},
            {"choosing_seconds",
             {{"total", answer.choosing_seconds},
              {"evidence", answer.evidence_seconds},
              {"evidence_shown", answer.shown_evidence_seconds},
              {"pilot", answer.by_sample() ? answer.choice.choosing_seconds : 0}}},
            {"choosing_share", answer.choosing_seconds / answer.choice.best().time.total()},
            {"whole", whole_json(whole_of(answer).seconds)},
            {"peak_bytes", *whole_of(answer).peak_bytes},
            {"warnings", answer.warnings}};
  json.update(answer.ledgers);
  if (answer.ranks) json["ranks"] = to_json(*answer.ranks);
  if (answer.by_sample()) add_left_out(json, answer.choice);
  json["paper_rule"].update(extrapolated_json(answer.paper.extrapolated));
  for (const ChooseRow& row : rows) json["candidates"].push_back(candidate_json(answer, row));
  add_tips(json, answer);
  if (answer.analysis) add_analysis(json, answer);
  return json;
}

std::string to_csv(const ChooseAnswer& answer, const Json& inputs) {
  const Columns of_all{"tried",      "regret",           "regret_error",  "rigor",
                       "unit_costs", "choosing_seconds", "whole_seconds", "peak_bytes"};
  Table table(workload_columns() + effect_columns() + Columns{"warnings", "role"} + candidate_columns() +
              Columns{"engine", "threads"} + count_columns("predicted_") +
              Columns{"predicted_seconds", "predicted_seconds_again", "predicted_seconds_error", "could_still_win",
                      "extrapolated", "extrapolated_because"} +
              count_columns("predicted_error_") + count_columns("counted_") +
              Columns{"measured_seconds", "measured_spread", "given_up_after_seconds", "not_run", "why_not",
                      "seconds_ratio", "counts_ratio", "unit_costs_ratio", "worst_count", "worst_count_ratio"} +
              of_all);
  Json shared = workload_cells(inputs);
  const Json json = to_json(answer);
  shared.update(effect_cells(json["effects"]));
  shared["warnings"] = joined(answer.warnings);
  shared["engine"] = name(answer.costs.engine);
  for (const std::string& name : of_all)
    if (json.contains(name)) shared[name] = json[name];
  shared["choosing_seconds"] = answer.choosing_seconds;
  shared["whole_seconds"] = json["whole"]["total"];
  const auto add = [&](const char* role, const Json& cells) {
    Json row = shared;
    row["role"] = role;
    row.update(cells);
    table.add(row);
  };
  const std::vector<ChooseRow> rows = rows_of(answer);
  for (std::size_t i = 0; i < rows.size(); ++i)
    add(role_of(answer, rows[i], i == 0), cells_of(answer, rows[i], json["candidates"][i]));
  add("paper rule", cells_of(answer.paper));
  return table.csv();
}

}  // namespace detp::cli
