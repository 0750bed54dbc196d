#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/picture/chart.hpp"
#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {
std::string effects_section(const ReportJson& report) {
  const ReportJson& effects = list(answer_of(report, "choice"), "effects");
  const std::string title = "Which effects this scene calls for";
  if (effects.empty()) return section_html(title, paragraph("Not made: stopped before it."));
  Rows rows{.head = {"effect", "state", "value", "on if", "over threshold", "evidence", "reason"}, .cells = {}};
  Chart chart{.description = "Evidence of each effect over its threshold",
              .x = {.title = "evidence over its threshold (1: at the threshold)", .label = number_label},
              .y = {.title = "", .categories = {}},
              .series = {{"on", {"#332288", "disc"}, Mark::circle}, {"off", {"#888888"}, Mark::circle, false, false}},
              .points = {},
              .x_limits = {{1, ""}}};
  std::string on;
  std::string close;
  for (const ReportJson& effect : effects) {
    const double value = number(effect, "value").value_or(0);
    const auto error = number(effect, "standard_error").value_or(0);
    const auto over = number(effect, "over_threshold");
    const bool is_on = effect.value("on", false);
    const bool is_close = effect.value("close", false);
    const std::string name = words(effect, "name");
    if (is_on) on += (on.empty() ? "" : ", ") + name;
    if (is_close) close += (close.empty() ? "" : ", ") + name;
    rows.cells.push_back({name,
                          is_on      ? "on"
                          : is_close ? "off, close"
                                     : "off",
                          error > 0 ? fmt::format("{:.3g} ± {:.1g}", value, error) : fmt::format("{:.3g}", value),
                          words(effect, "on_if"), ratio_words(over), words(effect, "evidence"),
                          words(effect, "reason")});
    if (!over) continue;
    constexpr double least = 0.01;  // of the axis
    chart.y.categories.push_back(name);
    chart.points.push_back({.series = is_on ? 0U : 1U,
                            .x = std::clamp(*over, least, 100.0),
                            .y = static_cast<double>(chart.y.categories.size() - 1),
                            .value = rows.words(rows.cells.size() - 1)});
  }
  std::string finding = on.empty() ? "No effect is on: rays and samples are as the formulas take them."
                                   : fmt::format("On: {}. All others are off.", on);
  if (!close.empty()) finding += fmt::format(" Close to its threshold: {}.", close);
  if (chart.points.empty()) return section_html(title, paragraph(finding) + table_html("effects", rows));
  return section_html(title, figure_html("evidence of effects", finding, chart_svg(chart), rows));
}

}  // namespace detp::validate
