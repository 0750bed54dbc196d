#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"

/// The candidates of the choice: their seconds, and how well seconds and tests were predicted.
namespace detp::validate {
namespace {

/// "box-tree with fan-out 8".
std::string candidate_words(const Json& candidate) {
  return fmt::format("{} with {}", words(candidate, "technique"), parameter_words(candidate));
}

std::string finding_of_choice(const Json& choice) {
  const Json& best = list(choice, "choice");
  std::string text = candidate_words(best) + " is the fastest";
  const std::string measured = shown_seconds(best, "measured_seconds", "measured_spread");
  const std::string predicted = shown_seconds(best, "predicted_seconds", "predicted_seconds_error");
  if (const auto tried = number(choice, "tried"); tried && !measured.empty())
    text += fmt::format(" of {:.0f} candidates that were run: {}", *tried, measured);
  else if (!predicted.empty())
    text += ": predicted " + predicted;
  if (const auto regret = number(choice, "regret")) {
    const std::string other = candidate_words(list(choice, "predicted_choice"));
    text += *regret < 0.005 ? ". It is what was predicted"
            : *regret <= number(choice, "regret_error").value_or(0)
                ? fmt::format(". What was predicted to be fastest, {}, is as fast within the noise of the runs", other)
                : fmt::format(". What was predicted to be fastest, {}, took {} longer", other, percent_label(*regret));
  }
  return text + ".";
}

std::string nearest_words(const Json& choice) {
  std::optional<double> least;
  std::string nearest;
  for (const Json& one : list(choice, "ruled_out")) {
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
  const auto is_measured = [&](const Json& technique) {
    return std::ranges::any_of(list(choice, "candidates"), [&](const Json& one) {
      return words(one, "technique") == technique && number(one, "measured_seconds");
    });
  };
  for (const Json& one : list(choice, "not_examined"))
    if (one.is_string() && !is_measured(one)) skipped += (skipped.empty() ? "" : ", ") + one.get<std::string>();
  if (!skipped.empty()) text += fmt::format("Not examined by the prediction, to save time: {}.", skipped);
  return text;
}

std::optional<double> tests_in(const Json& counts) {
  const auto cull = number(counts, "cull_tests");
  const auto disc = number(counts, "disc_tests");
  return cull && disc ? std::optional(*cull + *disc) : std::nullopt;
}

std::optional<double> ratio_of(std::optional<double> above, std::optional<double> below) {
  return above && below && *below > 0 && *above > 0 ? std::optional(*above / *below) : std::nullopt;
}

/// "within 4 %", "off by a factor of up to 2.1".
std::string deviation_words(double worst) {
  return worst < 1.5 ? fmt::format("within {:.0f} %", std::max(1.0, std::ceil(100 * (worst - 1))))
                     : fmt::format("off by a factor of up to {:.2g}", worst);
}

}  // namespace

std::string choice_section(const Json& report) {
  const Json& choice = answer_of(report, "choice");
  const std::string title = "Which technique is fastest";
  if (list(choice, "candidates").empty()) return section_html(title, paragraph("Not made: stopped before it."));
  Figure figure{.rows = {{"technique", "parameters", "predicted", "measured", "remark"}},
                .chart = {.description = "Seconds of the best candidate of each technique, predicted and measured",
                          .x = {.title = "time of a run", .label = seconds_label},
                          .series = {{"predicted", {"currentColor"}, Mark::circle, false, false},
                                     {"measured", {"currentColor"}, Mark::square},
                                     {"at least (ruled out)", {"currentColor"}, Mark::up, false, false}}}};
  const std::vector<std::string>& names = figure.chart.y.categories;
  const auto place_of = [&](const std::string& technique) {
    const auto found = std::ranges::find(names, technique);
    return found == names.end() ? figure.name(technique) : static_cast<double>(found - names.begin());
  };
  const Json& best = list(choice, "choice");
  for (const Json& one : list(choice, "candidates")) {
    const auto predicted = number(one, "predicted_seconds");
    const auto measured = number(one, "measured_seconds");
    const auto error = number(one, "predicted_seconds_error").value_or(0);
    const auto spread = number(one, "measured_spread").value_or(0);
    if (!predicted && !measured) continue;
    const std::string technique = words(one, "technique");
    figure.row({technique, parameter_words(one), shown_seconds(one, "predicted_seconds", "predicted_seconds_error"),
                shown_seconds(one, "measured_seconds", "measured_spread"), words(one, "why_not")});
    const bool is_best = technique == words(best, "technique") && list(one, "parameters") == list(best, "parameters");
    if (!is_best && (technique == words(best, "technique") || std::ranges::find(names, technique) != names.end()))
      continue;  // the table has it
    const double place = place_of(technique);
    const auto add = [&](std::size_t series, double seconds, double half) {
      ChartPoint& point = figure.point(series, seconds, place);
      if (half > 0) point.x_interval = Interval{std::max(seconds - half, seconds / 10), seconds + half};
      point.paint = paint_of(technique);
    };
    if (predicted) add(0, *predicted, error);
    if (measured) add(1, *measured, spread);
  }
  for (const Json& one : list(choice, "ruled_out")) {
    const auto least = number(one, "at_least_seconds");
    if (!least) continue;
    const std::string technique = words(one, "technique");
    figure.row({technique, "", "at least " + seconds_label(*least), "", "ruled out"});
    figure.point(2, *least, place_of(technique)).paint = paint_of(technique);
  }
  if (figure.chart.points.empty()) return section_html(title, paragraph("No candidate has a time."));
  return section_html(
      title, figure.html("seconds of each candidate", finding_of_choice(choice)) + paragraph(nearest_words(choice)));
}

std::string comparison_section(const Json& report) {
  const std::string title = "Predicted, counted, measured";
  Figure figure{
      .rows = {{"candidate", "tests predicted", "tests counted", "tests ratio", "seconds predicted", "seconds measured",
                "seconds ratio"}},
      .chart = {.description = "Predicted over counted tests and predicted over measured seconds of each candidate",
                .x = {.title = "predicted over found", .label = number_label},
                .series = {{"tests, over counted", {"#332288", "disc"}, Mark::circle},
                           {"seconds, over measured", {"#cc6677", "variable-radius"}, Mark::square}},
                .x_limits = {1}}};
  double worst_tests = 1;
  double worst_seconds = 1;
  for (const Json& one : list(answer_of(report, "choice"), "candidates")) {
    const auto predicted = tests_in(list(one, "predicted"));
    const auto counted = tests_in(list(one, "counted"));
    const auto tests_ratio = ratio_of(predicted, counted);
    const auto seconds_ratio = ratio_of(number(one, "predicted_seconds"), number(one, "measured_seconds"));
    if (!tests_ratio && !seconds_ratio) continue;
    std::string name = words(one, "technique");
    if (const std::string parameters = parameter_words(one); !parameters.empty()) name += " " + parameters;
    figure.row({name, predicted ? count_words(*predicted) : "", counted ? count_words(*counted) : "",
                ratio_words(tests_ratio), shown(one, "predicted_seconds", seconds_label),
                shown(one, "measured_seconds", seconds_label), ratio_words(seconds_ratio)});
    const double place = figure.name(name);
    const auto add = [&](std::size_t series, std::optional<double> found, double& worst) {
      if (!found) return;
      figure.point(series, *found, place);
      worst = std::max({worst, *found, 1 / *found});
    };
    add(0, tests_ratio, worst_tests);
    add(1, seconds_ratio, worst_seconds);
  }
  if (figure.chart.points.empty()) return section_html(title, paragraph("Not made: no candidate was run."));
  return section_html(
      title, figure.html("predicted over counted and measured",
                         fmt::format("Predicted tests are {} of those counted; predicted seconds are {} of those "
                                     "measured.",
                                     deviation_words(worst_tests), deviation_words(worst_seconds))));
}

}  // namespace detp::validate
