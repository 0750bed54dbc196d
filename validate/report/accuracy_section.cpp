#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detp/validate/picture/chart.hpp"
#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {
namespace {

struct EstimatorSign {
  std::string_view name;
  Paint paint;
  Mark mark;
};

// The colours of the notebooks.
constexpr std::array signs{EstimatorSign{"disc", {"#332288", "disc"}, Mark::circle},
                           EstimatorSign{"variable-radius", {"#cc6677", "variable-radius"}, Mark::square},
                           EstimatorSign{"area-corrected", {"#117733", "area-corrected"}, Mark::diamond},
                           EstimatorSign{"nearest", {"#ddcc77", "nearest"}, Mark::up},
                           EstimatorSign{"triangle-hits", {"#882255", "triangle-hits"}, Mark::down}};

std::optional<Interval> interval(const ReportJson& json, std::string_view key) {
  const ReportJson& ends = list(json, key);
  if (ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number()) return std::nullopt;
  return Interval{ends[0].get<double>(), ends[1].get<double>()};
}

std::string interval_words(const std::optional<Interval>& one) {
  return one ? fmt::format(" ({} to {})", percent_label(one->low), percent_label(one->high)) : "";
}

std::vector<std::string> cells(const ReportJson& point, bool answer) {
  const auto noise = number(point, "noise");
  const auto bias = number(point, "bias");
  const auto error = number(point, "error");
  return {words(point, "estimator"),
          words(point, "setting"),
          number(point, "photons") ? count_words(*number(point, "photons")) : "",
          noise ? percent_label(*noise) : "",
          bias ? percent_label(*bias) : "",
          error ? percent_label(*error) + interval_words(interval(point, "error_interval")) : "",
          number(point, "predicted_seconds") ? seconds_label(*number(point, "predicted_seconds")) : "",
          answer                              ? "the answer"
          : point.value("on_frontier", false) ? "on the frontier"
                                              : ""};
}

}  // namespace

std::string accuracy_section(const ReportJson& report) {
  const ReportJson& accuracy = answer_of(report, "accuracy");
  const std::string title = "What accuracy costs";
  if (list(accuracy, "points").empty()) {
    for (const ReportJson& part : list(report, "parts"))
      if (words(part, "name") == "accuracy" && !words(part, "not_made").empty())
        return section_html(title, paragraph("Not made: " + words(part, "not_made") + "."));
    return section_html(title, paragraph("Not made: stopped before it."));
  }
  Chart chart{.description = "Relative error of each estimator against the seconds of a run",
              .x = {.title = "predicted time, tracing included", .label = seconds_label},
              .y = {.title = "relative error", .label = percent_label},
              .series = {},
              .points = {}};
  for (const EstimatorSign& sign : signs) chart.series.push_back({std::string(sign.name), sign.paint, sign.mark, true});
  Rows rows{.head = {"estimator", "setting", "photon paths", "noise", "bias", "total", "time", "remark"}, .cells = {}};
  const auto add = [&](const ReportJson& point, bool answer) {
    const auto sign = std::ranges::find(signs, std::string_view(words(point, "estimator")), &EstimatorSign::name);
    const auto error = number(point, "error");
    const auto seconds = number(point, "predicted_seconds");
    if (sign == signs.end() || !error || !seconds) return;
    rows.cells.push_back(cells(point, answer));
    chart.points.push_back({.series = static_cast<std::size_t>(sign - signs.begin()),
                            .x = *seconds,
                            .y = *error,
                            .value = rows.words(rows.cells.size() - 1)});
    ChartPoint& made = chart.points.back();
    if (auto ends = interval(point, "error_interval")) made.y_interval = {std::max(ends->low, *error / 10), ends->high};
    made.marked = answer;
  };
  std::vector<ReportJson> points(list(accuracy, "points").begin(), list(accuracy, "points").end());
  std::ranges::stable_sort(points, {},
                           [](const ReportJson& one) { return number(one, "predicted_seconds").value_or(0); });
  // The answer lies on the line of its estimator: among the points, where its seconds are.
  bool answered = false;
  const ReportJson& answer = list(accuracy, "answer");
  for (const ReportJson& one : points) {
    if (!answered && number(one, "predicted_seconds") > number(answer, "predicted_seconds")) {
      add(answer, true);
      answered = true;
    }
    if (words(one, "estimator") == words(answer, "estimator") && one.value("rays", 0.0) == answer.value("rays", 1.0))
      continue;
    add(one, false);
  }
  if (!answered) add(answer, true);
  if (chart.points.empty()) return section_html(title, paragraph("No estimator has an error and a time."));
  const ReportJson& reference = list(accuracy, "reference");
  return section_html(
      title, figure_html("error against time",
                         words(answer, "text") + ". Ringed: the answer. Lower and further left is better.",
                         chart_svg(chart), rows) +
                 paragraph(fmt::format(
                     "The error is noise and bias together: root mean square over the samples by area, relative to "
                     "the root mean square irradiance. Intervals hold the error of one run with 95 %. The bias is "
                     "against {}.",
                     words(reference, "kind").empty() ? "a reference" : words(reference, "kind"))));
}

}  // namespace detp::validate
