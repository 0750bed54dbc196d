#include "choose_report.hpp"
#include "choose_rows.hpp"
#include "detp/validate/cli/report/columns.hpp"
#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"
#include "measured_report.hpp"

namespace detp::cli {
namespace {

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
