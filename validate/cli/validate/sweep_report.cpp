#include "validate_report.hpp"

#include <fmt/format.h>

#include <map>
#include <tuple>

#include "detp/sim/files/output_file.hpp"
#include "detp/validate/cli/report/workload_report.hpp"
#include "detp/validate/cli/text/table.hpp"

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
            {"form", name(summary.form)},
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
                   {.head = "form", .align = Align::left},
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

/// Values that claims have too are in the claims' columns.
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

void write_sweep_rows(const std::string& path, const std::vector<Deviation>& deviations, const std::stop_token& stop) {
  struct Row {
    const Deviation* any = nullptr;
    std::string published = {};
    std::string corrected = {};
    bool exact = true;  ///< predicted and observed without any difference
  };
  std::map<std::tuple<std::string, std::int64_t>, std::size_t> places;
  std::vector<Row> rows;
  for (const Deviation& deviation : deviations) {
    const std::string key =
        fmt::format("{} {} {} {} {} {}", deviation.dimension, deviation.samples, deviation.disc_share,
                    deviation.technique, deviation.parameters, deviation.quantity);
    const auto [place, is_new] = places.try_emplace({key, deviation.sphere}, rows.size());
    if (is_new) rows.push_back({.any = &deviation});
    Row& row = rows[place->second];
    const auto& observed = deviation.observed;
    row.exact = row.exact && observed.standard_error == 0 && observed.mean == deviation.predicted;
    (deviation.form == Form::published ? row.published : row.corrected) = fmt::format("{:.5g}", deviation.predicted);
  }
  sim::OutputFile file(path, stop);
  file.write(
      "dimension,samples,disc_share,technique,parameters,quantity,sphere,published,corrected,observed,"
      "standard_error\n");
  for (const Row& row : rows) {
    if (row.exact) continue;
    file.write(fmt::format("{},{:g},{:g},{},\"{}\",{},{},{},{},{:.5g},{:.2g}\n", row.any->dimension, row.any->samples,
                           row.any->disc_share, row.any->technique, row.any->parameters, row.any->quantity,
                           row.any->sphere, row.published, row.corrected, row.any->observed.mean,
                           row.any->observed.standard_error));
  }
  file.commit();
}

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
