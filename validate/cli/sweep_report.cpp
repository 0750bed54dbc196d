#include "sweep_report.hpp"

#include <fmt/format.h>

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
            {"tier", summary.tier},
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
                      summary.quantity, summary.tier, summary.compared, 100 * summary.median, 100 * summary.p95,
                      100 * summary.worst, 100 * summary.goal.worst, summary.beyond, where(summary.worst_at));
  return text;
}

std::string to_csv(const std::vector<Deviation>& deviations) {
  std::string csv =
      "dimension,samples,disc_share,technique,parameters,quantity,sphere,tier,predicted,observed,standard_error,"
      "deviation\n";
  for (const Deviation& row : deviations)
    csv += fmt::format("{},{:g},{:g},{},\"{}\",{},{},{},{:.6g},{:.6g},{:.2g},{:.4f}\n", row.dimension, row.samples,
                       row.disc_share, row.technique, row.parameters, row.quantity, row.sphere, row.tier, row.predicted,
                       row.observed.mean, row.observed.standard_error, row.relative());
  return csv;
}

}  // namespace

void report_sweep(const validate::SweepResult& sweep, Result& result) {
  const auto summaries = validate::summarise(sweep.deviations);
  Json& json = result.json["sweep"];
  json = {{"points", sweep.points}, {"measured", sweep.measured}, {"resumed", sweep.resumed}};
  json["summary"] = Json::array();
  for (const DeviationSummary& summary : summaries) json["summary"].push_back(to_json(summary));
  result.text += fmt::format("\n{} of {} workloads measured\n", sweep.measured, sweep.points) + to_text(summaries);
  result.csv = to_csv(sweep.deviations);
}

}  // namespace detp::cli
