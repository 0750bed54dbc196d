#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"

/// What the predictions rest on: verdicts on the closed forms, and the evidence of effects.
namespace detp::validate {

std::string verdict_section(const Json& report) {
  const Json& claims = list(answer_of(report, "verdicts"), "claims");
  const std::string title = "Do the closed forms hold here";
  if (claims.empty()) return section_html(title, paragraph("Not made: stopped before it."));
  Figure figure{
      .rows = {{"claim", "predicted", "counted", "differs", "allowed", "verdict", "control"}},
      .chart = {.description = "Difference of each closed form from the count, over what is allowed",
                .x = {.title = "difference, over the allowed one", .logarithmic = false, .label = number_label},
                .series = {{"agrees", {"#117733", "area-corrected"}, Mark::circle},
                           {"refuted", {"#cc6677", "variable-radius"}, Mark::cross},
                           {"undecided", {"#888888"}, Mark::diamond, false, false}},
                .x_limits = {-1, 1}}};
  std::array<std::size_t, 3> counts{};
  for (const Json& claim : claims) {
    const auto differs = number(claim, "relative_difference");
    const auto tolerance = number(claim, "tolerance");
    if (!differs || !tolerance || !(*tolerance > 0)) continue;
    const std::string verdict = words(claim, "verdict");
    const std::size_t series = verdict == "agrees" ? 0 : verdict == "refuted" ? 1 : 2;
    const std::string id = words(claim, "id");
    const std::string name = id.substr(0, id.rfind('.'));  // without the form
    figure.row({name, ratio_words(number(claim, "predicted")), ratio_words(number(claim, "observed")),
                fmt::format("{:+.1f} %", 100 * *differs), fmt::format("{:.3g} %", 100 * *tolerance), verdict,
                words(list(claim, "control"), "verdict")});
    ++counts.at(series);
    figure.point(series, std::clamp(*differs / *tolerance, -4.0, 4.0), figure.name(name));
  }
  if (figure.chart.points.empty()) return section_html(title, paragraph("No claim was judged."));
  const std::string finding = fmt::format(
      "{} of {} predictions of closed forms agree with the counts{}{}. Between the dashed lines is what is allowed.",
      counts[0], figure.rows.cells.size(), counts[1] > 0 ? fmt::format("; {} are refuted", counts[1]) : "",
      counts[2] > 0 ? fmt::format("; {} are undecided", counts[2]) : "");
  return section_html(title, figure.html("closed forms against counts", finding));
}

std::string effects_section(const Json& report) {
  const Json& effects = list(answer_of(report, "choice"), "effects");
  const std::string title = "Which effects this scene calls for";
  if (effects.empty()) return section_html(title, paragraph("Not made: stopped before it."));
  Figure figure{
      .rows = {{"effect", "state", "value", "on if", "over threshold", "evidence", "reason"}},
      .chart = {.description = "Evidence of each effect over its threshold",
                .x = {.title = "evidence over its threshold (1: at the threshold)", .label = number_label},
                .series = {{"on", {"#332288", "disc"}, Mark::circle}, {"off", {"#888888"}, Mark::circle, false, false}},
                .x_limits = {1}}};
  std::string on;
  std::string close;
  for (const Json& effect : effects) {
    const double value = number(effect, "value").value_or(0);
    const auto error = number(effect, "standard_error").value_or(0);
    const auto over = number(effect, "over_threshold");
    const bool is_on = effect.value("on", false);
    const bool is_close = effect.value("close", false);
    const std::string name = words(effect, "name");
    if (is_on) on += (on.empty() ? "" : ", ") + name;
    if (is_close) close += (close.empty() ? "" : ", ") + name;
    figure.row({name,
                is_on      ? "on"
                : is_close ? "off, close"
                           : "off",
                error > 0 ? fmt::format("{:.3g} ± {:.1g}", value, error) : fmt::format("{:.3g}", value),
                words(effect, "on_if"), ratio_words(over), words(effect, "evidence"), words(effect, "reason")});
    constexpr double least = 0.01;  // of the axis
    if (over) figure.point(is_on ? 0 : 1, std::clamp(*over, least, 100.0), figure.name(name));
  }
  std::string finding = on.empty() ? "No effect is on: rays and samples are as the formulas take them."
                                   : fmt::format("On: {}. All others are off.", on);
  if (!close.empty()) finding += fmt::format(" Close to its threshold: {}.", close);
  if (figure.chart.points.empty()) return section_html(title, paragraph(finding) + table_html("effects", figure.rows));
  return section_html(title, figure.html("evidence of effects", finding));
}

}  // namespace detp::validate
