#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "chart.hpp"
#include "labels.hpp"

namespace detp::validate {
namespace {

struct ZoneLayout {
  static constexpr double width = 440;
  static constexpr double left = 74;
  static constexpr double right = 8;
  static constexpr double top = 8;
  static constexpr double row_height = 36;
  static constexpr double text_size = 12;
  static constexpr double legend_column = 120;
  static constexpr double legend_line = 18;
};

}  // namespace

std::string zone_svg(const ZoneChart& chart) {
  if (chart.rows.empty() || chart.columns.empty()) throw std::invalid_argument("a map without cells cannot be drawn");
  const double cell =
      (ZoneLayout::width - ZoneLayout::left - ZoneLayout::right) / static_cast<double>(chart.columns.size());
  const double bottom = ZoneLayout::top + ZoneLayout::row_height * static_cast<double>(chart.rows.size());
  std::vector<Technique> present;
  for (const auto& row : chart.cells)
    for (const auto& one : row)
      if (one && std::ranges::find(present, one->technique) == present.end()) present.push_back(one->technique);
  constexpr auto columns = static_cast<std::size_t>((ZoneLayout::width - ZoneLayout::left) / ZoneLayout::legend_column);
  const auto lines = static_cast<double>((present.size() + columns - 1) / columns);
  Svg svg = Svg::in_page(ZoneLayout::width, bottom + 44 + ZoneLayout::legend_line * lines, chart.description);
  const auto place_of = [&](std::size_t row, std::size_t column) {
    return Rectangle{ZoneLayout::left + cell * static_cast<double>(column),
                     ZoneLayout::top + ZoneLayout::row_height * static_cast<double>(row), cell, ZoneLayout::row_height};
  };
  for (std::size_t row = 0; row < chart.rows.size(); ++row) {
    const Rectangle first = place_of(row, 0);
    svg.text(ZoneLayout::left - 6, first.y + ZoneLayout::row_height / 2 + 4, chart.rows[row],
             {.size = ZoneLayout::text_size, .anchor = Anchor::end});
    for (std::size_t column = 0; column < chart.columns.size(); ++column) {
      const auto& one = chart.cells.at(row).at(column);
      const Rectangle place = place_of(row, column);
      if (!one) {
        svg.rectangle(place, "none", "#888888");
        continue;
      }
      const std::string_view ink = text_colour_on(one->technique);
      svg.begin_value(one->value);
      svg.rectangle(place, colour_of(one->technique), "#ffffff");
      if (one->framed) svg.rectangle({place.x + 2.5, place.y + 2.5, place.width - 5, place.height - 5}, "none", ink);
      const double middle = place.x + place.width / 2;
      svg.text(middle, place.y + 16, code_of(one->technique),
               {.size = ZoneLayout::text_size, .anchor = Anchor::middle, .fill = ink, .bold = true});
      const double room = 0.55 * 10 * static_cast<double>(one->seconds.size());
      if (room < cell)
        svg.text(middle, place.y + 29, one->seconds, {.size = 10, .anchor = Anchor::middle, .fill = ink});
      svg.end_value();
    }
  }
  for (std::size_t column = 0; column < chart.columns.size(); ++column) {
    const Rectangle place = place_of(0, column);
    svg.text(place.x + cell / 2, bottom + 15, chart.columns[column],
             {.size = ZoneLayout::text_size, .anchor = Anchor::middle});
  }
  svg.text((ZoneLayout::left + ZoneLayout::width - ZoneLayout::right) / 2, bottom + 32, chart.x_title,
           {.size = ZoneLayout::text_size, .anchor = Anchor::middle});
  svg.text(12, (ZoneLayout::top + bottom) / 2, chart.y_title,
           {.size = ZoneLayout::text_size, .anchor = Anchor::middle, .upwards = true});
  for (std::size_t i = 0; i < present.size(); ++i) {
    const double x = ZoneLayout::left + ZoneLayout::legend_column * static_cast<double>(i % columns);
    const double y = bottom + 52 + ZoneLayout::legend_line * static_cast<double>(i / columns);
    svg.rectangle({x, y - 11, 26, 14}, colour_of(present[i]), "#888888");
    svg.text(x + 13, y, code_of(present[i]),
             {.size = 10, .anchor = Anchor::middle, .fill = text_colour_on(present[i])});
    svg.text(x + 32, y, name(present[i]), {.size = ZoneLayout::text_size});
  }
  return svg.finished();
}

}  // namespace detp::validate
