#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/picture/chart.hpp"
#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {
namespace {

std::optional<double> tests(const ReportJson& counts) {
  const auto cull = number(counts, "cull_tests");
  const auto disc = number(counts, "disc_tests");
  return cull && disc ? std::optional(*cull + *disc) : std::nullopt;
}

std::optional<double> ratio(std::optional<double> above, std::optional<double> below) {
  return above && below && *below > 0 && *above > 0 ? std::optional(*above / *below) : std::nullopt;
}

/// "within 4 %", "by a factor of 2.1".
std::string deviation(double worst) {
  return worst < 1.5 ? fmt::format("within {:.0f} %", std::max(1.0, std::ceil(100 * (worst - 1))))
                     : fmt::format("off by a factor of up to {:.2g}", worst);
}

}  // namespace

std::string comparison_section(const ReportJson& report) {
  const ReportJson& choice = answer_of(report, "choice");
  const std::string title = "Predicted, counted, measured";
  Rows rows{.head = {"candidate", "tests predicted", "tests counted", "tests ratio", "seconds predicted",
                     "seconds measured", "seconds ratio"},
            .cells = {}};
  Chart chart{.description = "Predicted over counted tests and predicted over measured seconds of each candidate",
              .x = {.title = "predicted over found", .label = number_label},
              .y = {.title = "", .categories = {}},
              .series = {{"tests, over counted", {"#332288", "disc"}, Mark::circle},
                         {"seconds, over measured", {"#cc6677", "variable-radius"}, Mark::square}},
              .points = {},
              .x_limits = {{1, ""}}};
  double worst_tests = 1;
  double worst_seconds = 1;
  for (const ReportJson& one : list(choice, "candidates")) {
    const auto predicted = tests(list(one, "predicted"));
    const auto counted = tests(list(one, "counted"));
    const auto tests_ratio = ratio(predicted, counted);
    const auto seconds = number(one, "predicted_seconds");
    const auto measured = number(one, "measured_seconds");
    const auto seconds_ratio = ratio(seconds, measured);
    if (!tests_ratio && !seconds_ratio) continue;
    std::string name = words(one, "technique");
    if (const std::string parameters = parameter_words(one); !parameters.empty()) name += " " + parameters;
    rows.cells.push_back({name, predicted ? count_words(*predicted) : "", counted ? count_words(*counted) : "",
                          ratio_words(tests_ratio), seconds ? seconds_label(*seconds) : "",
                          measured ? seconds_label(*measured) : "", ratio_words(seconds_ratio)});
    chart.y.categories.push_back(name);
    std::string value = rows.words(rows.cells.size() - 1);
    const auto add = [&](std::size_t series, std::optional<double> found, double& worst) {
      if (!found) return;
      chart.points.push_back({.series = series,
                              .x = *found,
                              .y = static_cast<double>(chart.y.categories.size() - 1),
                              .value = std::exchange(value, "")});
      worst = std::max({worst, *found, 1 / *found});
    };
    add(0, tests_ratio, worst_tests);
    add(1, seconds_ratio, worst_seconds);
  }
  if (chart.points.empty()) return section_html(title, paragraph("Not made: no candidate was run."));
  return section_html(title,
                      figure_html("predicted over counted and measured",
                                  fmt::format("Predicted tests are {} of those counted; predicted seconds are {} of "
                                              "those measured.",
                                              deviation(worst_tests), deviation(worst_seconds)),
                                  chart_svg(chart), rows));
}

}  // namespace detp::validate
