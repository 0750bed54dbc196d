#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"

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

std::optional<Interval> interval_at(const Json& json, std::string_view key) {
  const Json& ends = list(json, key);
  if (ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number()) return std::nullopt;
  return Interval{ends[0].get<double>(), ends[1].get<double>()};
}

std::string interval_words(const std::optional<Interval>& one) {
  return one ? fmt::format(" ({} to {})", percent_label(one->low), percent_label(one->high)) : "";
}

std::vector<std::string> row_of(const Json& point, bool answer) {
  const std::string error = shown(point, "error", percent_label);
  return {words(point, "estimator"),
          words(point, "setting"),
          shown(point, "photons", count_words),
          shown(point, "noise", percent_label),
          shown(point, "bias", percent_label),
          error.empty() ? "" : error + interval_words(interval_at(point, "error_interval")),
          shown(point, "predicted_seconds", seconds_label),
          answer                              ? "the answer"
          : point.value("on_frontier", false) ? "on the frontier"
                                              : ""};
}

}  // namespace

std::string accuracy_section(const Json& report) {
  const Json& accuracy = answer_of(report, "accuracy");
  const std::string title = "What accuracy costs";
  if (list(accuracy, "points").empty()) {
    for (const Json& part : list(report, "parts"))
      if (words(part, "name") == "accuracy" && !words(part, "not_made").empty())
        return section_html(title, paragraph("Not made: " + words(part, "not_made") + "."));
    return section_html(title, paragraph("Not made: stopped before it."));
  }
  Figure figure{.rows = {{"estimator", "setting", "photon paths", "noise", "bias", "total", "time", "remark"}},
                .chart = {.description = "Relative error of each estimator against the seconds of a run",
                          .x = {.title = "predicted time, tracing included", .label = seconds_label},
                          .y = {.title = "relative error", .label = percent_label}}};
  for (const EstimatorSign& sign : signs)
    figure.chart.series.push_back({std::string(sign.name), sign.paint, sign.mark, true});
  const auto add = [&](const Json& point, bool answer) {
    const auto sign = std::ranges::find(signs, std::string_view(words(point, "estimator")), &EstimatorSign::name);
    const auto error = number(point, "error");
    const auto seconds = number(point, "predicted_seconds");
    if (sign == signs.end() || !error || !seconds) return;
    figure.row(row_of(point, answer));
    ChartPoint& made = figure.point(static_cast<std::size_t>(sign - signs.begin()), *seconds, *error);
    if (auto ends = interval_at(point, "error_interval"))
      made.y_interval = {std::max(ends->low, *error / 10), ends->high};
    made.marked = answer;
  };
  std::vector<Json> points(list(accuracy, "points").begin(), list(accuracy, "points").end());
  std::ranges::stable_sort(points, {}, [](const Json& one) { return number(one, "predicted_seconds").value_or(0); });
  // The answer lies on the line of its estimator: among the points, where its seconds are.
  bool answered = false;
  const Json& answer = list(accuracy, "answer");
  for (const Json& one : points) {
    if (!answered && number(one, "predicted_seconds") > number(answer, "predicted_seconds")) {
      add(answer, true);
      answered = true;
    }
    if (words(one, "estimator") == words(answer, "estimator") && one.value("rays", 0.0) == answer.value("rays", 1.0))
      continue;
    add(one, false);
  }
  if (!answered) add(answer, true);
  if (figure.chart.points.empty()) return section_html(title, paragraph("No estimator has an error and a time."));
  const Json& reference = list(accuracy, "reference");
  return section_html(
      title, figure.html("error against time",
                         words(answer, "text") + ". Ringed: the answer. Lower and further left is better.") +
                 paragraph(fmt::format(
                     "The error is noise and bias together: root mean square over the samples by area, relative to "
                     "the root mean square irradiance. Intervals hold the error of one run with 95 %. The bias is "
                     "against {}.",
                     words(reference, "kind").empty() ? "a reference" : words(reference, "kind"))));
}

}  // namespace detp::validate
