#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/picture/labels.hpp"
#include "parts.hpp"

namespace detp::validate {
namespace {

/// What would change the choice, by the tips of the choice and by the map.
std::string finding_of_map(const Json& choice, const Json& map, const std::string& here) {
  std::string others;
  std::size_t count = 0;
  std::size_t same = 0;
  for (const Json& cell : list(map, "cells")) {
    const std::string technique = words(list(cell, "predicted"), "technique");
    if (technique.empty()) continue;
    ++count;
    if (technique == here)
      ++same;
    else if (others.find(technique) == std::string::npos)
      others += (others.empty() ? "" : ", ") + technique;
  }
  std::string text =
      same == count
          ? fmt::format("{} is predicted to be the fastest in all {} cells around this workload.", here, count)
          : fmt::format("{} is predicted to be the fastest in {} of {} cells; elsewhere: {}.", here, same, count,
                        others);
  const Json& range = list(choice, "tips_range");
  if (list(choice, "tips").empty() && list(range, "disc_radius").size() == 2 && list(range, "rays").size() == 2)
    text += fmt::format(" No other examined technique wins for radii from {:.3g} to {:.3g} or for {} to {} rays.",
                        list(range, "disc_radius")[0].get<double>(), list(range, "disc_radius")[1].get<double>(),
                        count_words(list(range, "rays")[0].get<double>()),
                        count_words(list(range, "rays")[1].get<double>()));
  return text;
}

bool near(double a, double b) { return std::abs(a / b - 1) < 1e-3; }

}  // namespace

std::string map_section(const Json& report) {
  const Json& map = answer_of(report, "map");
  const Json& choice = answer_of(report, "choice");
  const std::string title = "What would change the choice";
  if (list(map, "cells").empty()) return section_html(title, paragraph("Not made: stopped before it."));
  std::vector<double> rays;
  std::vector<double> radii;
  for (const Json& one : list(list(map, "axes"), "rays")) rays.push_back(one.get<double>());
  for (const Json& one : list(list(map, "axes"), "disc_radius")) radii.push_back(one.get<double>());
  const double rays_here = number(list(choice, "inputs"), "rays").value_or(0);
  const double radius_here = number(list(choice, "inputs"), "disc_radius").value_or(0);
  std::ranges::reverse(radii);  // the largest above
  ZoneChart chart{.description = "The technique predicted to be fastest, for numbers of rays and disc radii",
                  .x_title = "rays",
                  .y_title = "disc radius",
                  .columns = {},
                  .rows = {},
                  .cells = std::vector(radii.size(), std::vector<std::optional<ZoneCell>>(rays.size()))};
  for (const double one : rays) chart.columns.push_back(rays_label(one));
  for (const double one : radii) chart.rows.push_back(fmt::format("{:.3g}", one));
  Rows rows{{"rays", "disc radius", "X", "fastest", "parameters", "predicted", "remark"}};
  std::string here = words(list(choice, "choice"), "technique");
  for (const Json& cell : list(map, "cells")) {
    const Json& predicted = list(cell, "predicted");
    const auto technique = technique_named(words(predicted, "technique"));
    const auto row = std::ranges::find(radii, number(cell, "disc_radius").value_or(0));
    const auto column = std::ranges::find(rays, number(cell, "rays").value_or(0));
    if (!technique || row == radii.end() || column == rays.end()) continue;
    const bool framed = near(*column, rays_here) && near(*row, radius_here);
    if (framed) here = words(predicted, "technique");
    rows.cells.push_back({count_words(*column), fmt::format("{:.3g}", *row), ratio_words(number(cell, "x")),
                          words(predicted, "technique"), parameter_words(predicted),
                          shown_seconds(predicted, "seconds", "seconds_error"), framed ? "this workload" : ""});
    chart.cells[static_cast<std::size_t>(row - radii.begin())][static_cast<std::size_t>(column - rays.begin())] =
        ZoneCell{*technique, rows.last_words(), shown(predicted, "seconds", seconds_label), framed};
  }
  std::string tips;
  for (const Json& tip : list(choice, "tips"))
    if (const std::string text = words(tip, "text"); !text.empty())
      tips += fmt::format("<li>{}</li>\n", xml_text(text));
  return section_html(
      title, figure_html("the fastest technique by rays and radius",
                         finding_of_map(choice, map, here) + " This workload is framed.", zone_svg(chart), rows) +
                 (tips.empty() ? "" : "<ul>\n" + tips + "</ul>\n"));
}

}  // namespace detp::validate
