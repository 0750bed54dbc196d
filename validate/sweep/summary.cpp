#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "detp/sim/files/output_file.hpp"
#include "sweep.hpp"

namespace detp::validate {
namespace {

Goal goal_of(const Deviation& deviation) {
  if (deviation.quantity == "L_i") return {0.02, 0.02};
  if (deviation.technique == "sphere-cache") return {0.10, 0.04};
  if (deviation.technique == "box-tree")
    return deviation.quantity == "culls" || deviation.quantity == "visits" ? Goal{0.15, 0.05} : Goal{0.12, 0.05};
  return {0.03, 0.03};
}

bool same_quantity(const DeviationSummary& summary, const Deviation& deviation) {
  return summary.technique == deviation.technique && summary.quantity == deviation.quantity &&
         summary.form == deviation.form;
}

void fill(DeviationSummary& summary, std::span<const Deviation> deviations) {
  std::vector<double> sizes;
  for (const Deviation& deviation : deviations) {
    if (!same_quantity(summary, deviation)) continue;
    if (!(deviation.relative_error() <= summary.goal.worst / 4)) {
      ++summary.noisy;
      continue;
    }
    const double size = std::abs(deviation.relative());
    if (size > summary.goal.worst + 3 * deviation.relative_error()) ++summary.beyond;
    if (sizes.empty() || size > summary.worst) {
      summary.worst = size;
      summary.worst_at = deviation;
    }
    sizes.push_back(size);
  }
  summary.compared = sizes.size();
  if (sizes.empty()) return;
  summary.median = median(sizes);
  summary.p95 = quantile(sizes, 0.95);
}

/// Of the largest deviation.
Json place_json(const Deviation& worst) {
  return {{"dimension", worst.dimension},    {"samples", worst.samples},
          {"disc_share", worst.disc_share},  {"parameters", worst.parameters},
          {"sphere", worst.sphere},          {"predicted", worst.predicted},
          {"observed", worst.observed.mean}, {"standard_error", worst.observed.standard_error}};
}

}  // namespace

std::vector<DeviationSummary> summarise(std::span<const Deviation> deviations) {
  std::vector<DeviationSummary> summaries;
  for (const Deviation& deviation : deviations) {
    const auto known = std::find_if(summaries.begin(), summaries.end(),
                                    [&](const DeviationSummary& summary) { return same_quantity(summary, deviation); });
    if (known != summaries.end()) continue;
    summaries.push_back({.technique = deviation.technique,
                         .quantity = deviation.quantity,
                         .form = deviation.form,
                         .goal = goal_of(deviation),
                         .worst_at = {}});
    fill(summaries.back(), deviations);
  }
  return summaries;
}

const Fields<DeviationSummary>& summary_fields() {
  using Summary = DeviationSummary;
  static const Fields<Summary> fields{
      {"technique", "", "whose counts are compared", &Summary::technique},
      {"quantity", "", "a count, or m_i (rebuilds) or L_i (rays in the list) of a sphere", &Summary::quantity},
      {"form", "", "published: the paper's formula; corrected: ours",
       [](const Summary& one) { return name(one.form); }},
      {"compared", "", "comparisons with a small enough standard error", &Summary::compared},
      {"too_noisy", "", "comparisons left out: their standard error exceeds a quarter of the goal", &Summary::noisy},
      {"median", "", "of |predicted/observed - 1|", &Summary::median},
      {"p95", "", "of 20 deviations, 19 are smaller", &Summary::p95},
      {"worst", "", "the largest deviation", &Summary::worst},
      {"goal_median", "", "what the median should not exceed", [](const Summary& one) { return one.goal.median; }},
      {"goal_worst", "", "what the worst should not exceed", [](const Summary& one) { return one.goal.worst; }},
      {"beyond_goal", "", "comparisons beyond goal_worst by more than three standard errors", &Summary::beyond},
      {"goal_met", "", "none is beyond, and the median is within its goal", &Summary::met},
      {"worst_at", "", "the comparison with the largest deviation",
       [](const Summary& one) { return one.compared > 0 ? place_json(one.worst_at) : left_out(); }}};
  return fields;
}

const Fields<Deviation>& deviation_fields() {
  using Row = Deviation;
  static const Fields<Row> fields{
      {"scene", "", "where the samples are",
       [](const Row& row) {
         return row.dimension == 3 ? "uniform samples in a cube" : "uniform samples on the faces of a cube";
       }},
      {"field", "", "of rays", [](const Row&) { return "isotropic"; }},
      {"samples", "", "number of samples", [](const Row& row) { return static_cast<std::int64_t>(row.samples); }},
      {"dimension", "", "of the samples", &Row::dimension},
      {"id", "", "the technique, and the form of the formula",
       [](const Row& row) { return fmt::format("sweep-{}.{}", row.technique, name(row.form)); }},
      {"quantity", "", "what is predicted and counted", &Row::quantity},
      {"form", "", "published: the paper's formula; corrected: ours", [](const Row& row) { return name(row.form); }},
      {"predicted", "", "by the formula", &Row::predicted},
      {"observed", "", "counted: mean over sets of samples", [](const Row& row) { return row.observed.mean; }},
      {"standard_error", "", "of observed", [](const Row& row) { return row.observed.standard_error; }},
      {"relative_difference", "", "observed over predicted, less 1",
       [](const Row& row) { return row.observed.mean / row.predicted - 1; }},
      {"technique", "", "whose counts are compared", &Row::technique},
      {"parameters", "", "of the technique", &Row::parameters},
      {"disc_share", "", "radius of the discs over that of the sphere around them", &Row::disc_share},
      {"i", "", "number of the nested sphere, where the count is that of one",
       [](const Row& row) { return row.sphere > 0 ? Json(row.sphere) : left_out(); }}};
  return fields;
}

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

}  // namespace detp::validate
