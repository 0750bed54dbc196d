#include "sweep_report.hpp"

#include <fmt/format.h>

#include "workload_options.hpp"

namespace detp::cli {
namespace {

using validate::Deviation;
using validate::DeviationSummary;

std::string where(const Deviation& row) {
  std::string place =
      fmt::format("D {}, n {:g}, d/r0 {:g}, {}", row.dimension, row.samples, row.disc_share, row.parameters);
  return row.sphere > 0 ? place + fmt::format(", i {}", row.sphere) : place;
}

Json to_json(const DeviationSummary& summary) {
  Json json{{"technique", summary.technique},
            {"quantity", summary.quantity},
            {"tier", name(summary.form)},
            {"compared", summary.compared},
            {"too_noisy", summary.noisy},
            {"median", summary.median},
            {"p95", summary.p95},
            {"worst", summary.worst},
            {"goal_median", summary.goal.median},
            {"goal_worst", summary.goal.worst},
            {"beyond_goal", summary.beyond},
            {"goal_met", summary.met()}};
  if (summary.compared > 0) {
    const Deviation& worst = summary.worst_at;
    json["worst_at"] = {{"dimension", worst.dimension},    {"samples", worst.samples},
                        {"disc_share", worst.disc_share},  {"parameters", worst.parameters},
                        {"sphere", worst.sphere},          {"predicted", worst.predicted},
                        {"observed", worst.observed.mean}, {"standard_error", worst.observed.standard_error}};
  }
  return json;
}

std::string to_text(const std::vector<DeviationSummary>& summaries) {
  std::string text =
      fmt::format("{:<24} {:<13} {:<10} {:>8} {:>7} {:>7} {:>8} {:>7} {:>6}  {}\n", "technique", "quantity", "tier",
                  "compared", "median", "p95", "worst", "goal", "beyond", "worst at");
  for (const DeviationSummary& summary : summaries)
    if (summary.compared > 0)
      text +=
          fmt::format("{:<24} {:<13} {:<10} {:>8} {:>6.2f}% {:>6.1f}% {:>7.1f}% {:>6g}% {:>6}  {}\n", summary.technique,
                      summary.quantity, name(summary.form), summary.compared, 100 * summary.median, 100 * summary.p95,
                      100 * summary.worst, 100 * summary.goal.worst, summary.beyond, where(summary.worst_at));
  return text;
}

/// A row in the table of the claims. Uses the claims' column names for values with the same meaning.
Json cells_of(const Deviation& row) {
  Json cells{{"scene", row.dimension == 3 ? "uniform samples in a cube" : "uniform samples on the faces of a cube"},
             {"field", name(sim::Field::isotropic)},
             {"samples", whole(row.samples)},
             {"dimension", row.dimension},
             {"id", fmt::format("sweep-{}.{}", row.technique, name(row.form))},
             {"quantity", row.quantity},
             {"form", name(row.form)},
             {"predicted", row.predicted},
             {"observed", row.observed.mean},
             {"standard_error", row.observed.standard_error},
             {"relative_difference", row.observed.mean / row.predicted - 1},
             {"technique", row.technique},
             {"parameters", row.parameters},
             {"disc_share", row.disc_share}};
  if (row.sphere > 0) cells["i"] = row.sphere;
  return cells;
}

}  // namespace

Columns sweep_columns() { return {"technique", "parameters", "disc_share", "i"}; }

void report_sweep(const validate::SweepResult& sweep, Table& table, Result& result) {
  const auto summaries = validate::summarise(sweep.deviations);
  Json& json = result.json["sweep"];
  json = {{"points", sweep.points}, {"measured", sweep.measured}, {"resumed", sweep.resumed}};
  json["summary"] = Json::array();
  for (const DeviationSummary& summary : summaries) json["summary"].push_back(to_json(summary));
  result.text += fmt::format("\n{} of {} workloads measured\n", sweep.measured, sweep.points) + to_text(summaries);
  if (sweep.measured < sweep.points) result.stopped = {sweep.measured, sweep.points, "workloads of the sweep"};
  for (const Deviation& row : sweep.deviations) table.add(cells_of(row));
}

}  // namespace detp::cli
