#include <fmt/format.h>

#include <algorithm>

#include "detp/validate/picture/chart.hpp"
#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {
namespace {

std::string finding_of(const ReportJson& choice) {
  const ReportJson& best = list(choice, "choice");
  std::string text = fmt::format("{} with {} is the fastest", words(best, "technique"), parameter_words(best));
  if (const auto tried = number(choice, "tried"); tried && number(best, "measured_seconds"))
    text += fmt::format(" of {:.0f} candidates that were run: {}", *tried,
                        seconds_words(*number(best, "measured_seconds"), number(best, "measured_spread")));
  else if (const auto seconds = number(best, "predicted_seconds"))
    text += fmt::format(": predicted {}", seconds_words(*seconds, number(best, "predicted_seconds_error")));
  if (const auto regret = number(choice, "regret"))
    text += *regret < 0.005 ? ". It is what was predicted"
            : *regret <= number(choice, "regret_error").value_or(0)
                ? fmt::format(". What was predicted to be fastest, {} with {}, is as fast within the noise of the runs",
                              words(list(choice, "predicted_choice"), "technique"),
                              parameter_words(list(choice, "predicted_choice")))
                : fmt::format(". What was predicted to be fastest, {} with {}, took {} longer",
                              words(list(choice, "predicted_choice"), "technique"),
                              parameter_words(list(choice, "predicted_choice")), percent_label(*regret));
  return text + ".";
}

std::string nearest_words(const ReportJson& choice) {
  std::optional<double> least;
  std::string nearest;
  for (const ReportJson& one : list(choice, "ruled_out")) {
    const auto seconds = number(one, "at_least_seconds");
    if (!seconds || (least && *least <= *seconds)) continue;
    least = seconds;
    nearest = words(one, "technique");
  }
  const auto best =
      number(list(choice, "predicted_choice").empty() ? list(choice, "choice") : list(choice, "predicted_choice"),
             "predicted_seconds");
  std::string text;
  if (least && best)
    text = fmt::format(
        "Of the techniques that were ruled out by prediction, {} would come nearest: at best {:.2g} times as long. ",
        nearest, *least / *best);
  std::string skipped;
  const auto is_measured = [&](const ReportJson& technique) {
    return std::ranges::any_of(list(choice, "candidates"), [&](const ReportJson& one) {
      return words(one, "technique") == technique && number(one, "measured_seconds");
    });
  };
  for (const ReportJson& one : list(choice, "not_examined"))
    if (one.is_string() && !is_measured(one)) skipped += (skipped.empty() ? "" : ", ") + one.get<std::string>();
  if (!skipped.empty()) text += fmt::format("Not examined by the prediction, to save time: {}.", skipped);
  return text;
}

}  // namespace

std::string choice_section(const ReportJson& report) {
  const ReportJson& choice = answer_of(report, "choice");
  const std::string title = "Which technique is fastest";
  if (list(choice, "candidates").empty()) return section_html(title, paragraph("Not made: stopped before it."));
  Rows rows{.head = {"technique", "parameters", "predicted", "measured", "remark"}, .cells = {}};
  Chart chart{.description = "Seconds of the best candidate of each technique, predicted and measured",
              .x = {.title = "time of a run", .label = seconds_label},
              .y = {.title = "", .categories = {}},
              .series = {{"predicted", {"currentColor"}, Mark::circle, false, false},
                         {"measured", {"currentColor"}, Mark::square},
                         {"at least (ruled out)", {"currentColor"}, Mark::up, false, false}},
              .points = {}};
  std::vector<std::string>& names = chart.y.categories;
  const auto row_of = [&](const std::string& technique) {
    const auto found = std::ranges::find(names, technique);
    if (found == names.end()) names.push_back(technique);
    return static_cast<double>(std::ranges::find(names, technique) - names.begin());
  };
  const ReportJson& best = list(choice, "choice");
  for (const ReportJson& one : list(choice, "candidates")) {
    const auto predicted = number(one, "predicted_seconds");
    const auto measured = number(one, "measured_seconds");
    const auto error = number(one, "predicted_seconds_error").value_or(0);
    const auto spread = number(one, "measured_spread").value_or(0);
    if (!predicted && !measured) continue;
    const std::string technique = words(one, "technique");
    rows.cells.push_back({technique, parameter_words(one), predicted ? seconds_words(*predicted, error) : "",
                          measured ? seconds_words(*measured, spread) : "", words(one, "why_not")});
    const bool is_best = technique == words(best, "technique") && list(one, "parameters") == list(best, "parameters");
    if (!is_best && (technique == words(best, "technique") || std::ranges::find(names, technique) != names.end()))
      continue;  // the table has it
    const double row = row_of(technique);
    std::string value = rows.words(rows.cells.size() - 1);
    const auto add = [&](std::size_t series, double seconds, double half) {
      chart.points.push_back({.series = series, .x = seconds, .y = row, .value = std::exchange(value, "")});
      if (half > 0) chart.points.back().x_interval = Interval{std::max(seconds - half, seconds / 10), seconds + half};
      chart.points.back().paint = paint_of(technique);
    };
    if (predicted) add(0, *predicted, error);
    if (measured) add(1, *measured, spread);
  }
  for (const ReportJson& one : list(choice, "ruled_out")) {
    const auto least = number(one, "at_least_seconds");
    if (!least) continue;
    const std::string technique = words(one, "technique");
    rows.cells.push_back({technique, "", "at least " + seconds_label(*least), "", "ruled out"});
    chart.points.push_back(
        {.series = 2, .x = *least, .y = row_of(technique), .value = rows.words(rows.cells.size() - 1)});
    chart.points.back().paint = paint_of(technique);
  }
  if (chart.points.empty()) return section_html(title, paragraph("No candidate has a time."));
  return section_html(title, figure_html("seconds of each candidate", finding_of(choice), chart_svg(chart), rows) +
                                 paragraph(nearest_words(choice)));
}

}  // namespace detp::validate
