#include "sweep_report.hpp"

#include <fmt/format.h>

#include "text_table.hpp"
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

Json summary_json(const DeviationSummary& summary) {
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

std::string to_text(const std::vector<DeviationSummary>& summaries, const Screen& screen) {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "quantity", .align = Align::left},
                   {.head = "tier", .align = Align::left},
                   {.head = "compared", .spare = 2},
                   {.head = "median"},
                   {.head = "p95", .spare = 1},
                   {.head = "worst"},
                   {.head = "goal"},
                   {.head = "beyond"},
                   {.head = "worst at", .align = Align::left, .spare = 3}});
  for (const DeviationSummary& summary : summaries) {
    if (summary.compared == 0) continue;
    table.add({{summary.technique},
               {summary.quantity},
               {std::string(name(summary.form))},
               {fmt::format("{}", summary.compared)},
               {fmt::format("{:.2f}%", 100 * summary.median)},
               {fmt::format("{:.1f}%", 100 * summary.p95)},
               {fmt::format("{:.1f}%", 100 * summary.worst), summary.met() ? Style::plain : Style::doubtful},
               {fmt::format("{:g}%", 100 * summary.goal.worst)},
               {fmt::format("{}", summary.beyond)},
               {where(summary.worst_at)}});
  }
  return table.text(screen) +
         legend(screen,
                "median, p95, worst: of the deviations of predictions from counts. goal: what the worst should not "
                "exceed. beyond: how many do. D: dimension of the samples, n: their number, d/r0: radius of the discs "
                "over that of the sphere around them, i: number of a nested sphere.");
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

void report_sweep(const validate::SweepResult& sweep, const Screen& screen, Table& table, Result& result) {
  const auto summaries = validate::summarise(sweep.deviations);
  Json& json = result.json["sweep"];
  json = {{"points", sweep.points}, {"measured", sweep.measured}, {"resumed", sweep.resumed}};
  json["summary"] = Json::array();
  for (const DeviationSummary& summary : summaries) json["summary"].push_back(summary_json(summary));
  result.text +=
      fmt::format("\n{} of {} workloads measured\n", sweep.measured, sweep.points) + to_text(summaries, screen);
  if (sweep.measured < sweep.points) result.stopped = {sweep.measured, sweep.points, "workloads of the sweep"};
  for (const Deviation& row : sweep.deviations) table.add(cells_of(row));
}

}  // namespace detp::cli
