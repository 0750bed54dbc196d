#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/picture/chart.hpp"
#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"
#include "sections.hpp"

namespace detp::validate {
namespace {

std::string percent_with_sign(double share) { return fmt::format("{:+.1f} %", 100 * share); }

std::size_t series_of(const std::string& verdict) { return verdict == "agrees" ? 0 : verdict == "refuted" ? 1 : 2; }

/// "choice.box-tree.cull-tests.corrected" without its form.
std::string stem(const std::string& id) { return id.substr(0, id.rfind('.')); }

}  // namespace

std::string verdict_section(const ReportJson& report) {
  const ReportJson& claims = list(answer_of(report, "verdicts"), "claims");
  const std::string title = "Do the closed forms hold here";
  if (claims.empty()) return section_html(title, paragraph("Not made: stopped before it."));
  Rows rows{.head = {"claim", "predicted", "counted", "differs", "allowed", "verdict", "control"}, .cells = {}};
  Chart chart{.description = "Difference of each closed form from the count, over what is allowed",
              .x = {.title = "difference, over the allowed one", .logarithmic = false, .label = number_label},
              .y = {.title = "", .categories = {}},
              .series = {{"agrees", {"#117733", "area-corrected"}, Mark::circle},
                         {"refuted", {"#cc6677", "variable-radius"}, Mark::cross},
                         {"undecided", {"#888888"}, Mark::diamond, false, false}},
              .points = {},
              .x_limits = {{-1, ""}, {1, ""}}};
  std::array<std::size_t, 3> counts{};
  for (const ReportJson& claim : claims) {
    const auto differs = number(claim, "relative_difference");
    const auto tolerance = number(claim, "tolerance");
    const auto observed = number(claim, "observed");
    if (!differs || !tolerance || !(*tolerance > 0)) continue;
    const std::string verdict = words(claim, "verdict");
    const std::string name = stem(words(claim, "id"));
    rows.cells.push_back({name, ratio_words(number(claim, "predicted")), ratio_words(observed),
                          percent_with_sign(*differs), fmt::format("{:.3g} %", 100 * *tolerance), verdict,
                          words(list(claim, "control"), "verdict")});
    ++counts.at(series_of(verdict));
    chart.y.categories.push_back(name);
    chart.points.push_back({.series = series_of(verdict),
                            .x = std::clamp(*differs / *tolerance, -4.0, 4.0),
                            .y = static_cast<double>(chart.y.categories.size() - 1),
                            .value = rows.words(rows.cells.size() - 1)});
  }
  if (chart.points.empty()) return section_html(title, paragraph("No claim was judged."));
  const std::string finding = fmt::format(
      "{} of {} predictions of closed forms agree with the counts{}{}. Between the dashed lines is what is allowed.",
      counts[0], rows.cells.size(), counts[1] > 0 ? fmt::format("; {} are refuted", counts[1]) : "",
      counts[2] > 0 ? fmt::format("; {} are undecided", counts[2]) : "");
  return section_html(title, figure_html("closed forms against counts", finding, chart_svg(chart), rows));
}

}  // namespace detp::validate
