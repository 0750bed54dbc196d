#include "chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "labels.hpp"

namespace detp::validate {
namespace {

struct ChartLayout {
  static constexpr double width = 440;
  static constexpr double text_size = 12;
  static constexpr double letter = 0.56;  // width of a character over its size, about
  static constexpr double row_height = 26;
  static constexpr double dense_row_height = 19;  // if there are many names
  static constexpr std::size_t many_names = 16;
  static constexpr double plain_height = 230;
  static constexpr double right = 26;  // half a label of the last tick
  static constexpr double top = 12;
  static constexpr double axis_room = 40;  // below: tick labels and title
  static constexpr double legend_line = 18;
  static constexpr double mark_size = 9;
  static constexpr std::size_t longest_name = 32;  // characters of a name on an axis
};

double text_width(const std::string& text) {
  return ChartLayout::letter * ChartLayout::text_size * static_cast<double>(text.size());
}

std::string tick_label(const ChartAxis& axis, double value) {
  return axis.label != nullptr ? axis.label(value) : fmt::format("{:.6g}", value);
}

/// One axis: which values it has, and where they are.
class Scale {
 public:
  Scale(const ChartAxis& axis, std::vector<double> values, double begin, double end)
      : axis_(axis), begin_(begin), end_(end) {
    if (!axis.categories.empty()) {
      low_ = -0.5;
      high_ = static_cast<double>(axis.categories.size()) - 0.5;
      return;
    }
    if (axis.logarithmic) {
      std::erase_if(values, [](double value) { return !(value > 0); });
      for (double& value : values) value = std::log10(value);
    }
    if (values.empty()) values = {0};
    low_ = std::ranges::min(values);
    high_ = std::ranges::max(values);
    const double least = axis.logarithmic ? 0.4 : std::max(1e-12, 0.1 * std::abs(high_));
    const double more = std::max(0.06 * (high_ - low_), 0.5 * (least - (high_ - low_)));
    low_ -= more;
    high_ += more;
  }

  [[nodiscard]] double place(double value) const {
    if (axis_.categories.empty() && axis_.logarithmic) value = value > 0 ? std::log10(value) : low_;
    const double share = (std::clamp(value, low_, high_) - low_) / (high_ - low_);
    return begin_ + share * (end_ - begin_);
  }

  /// With room for labels of this ChartLayout::width or height.
  [[nodiscard]] std::vector<double> ticks(double room) const {
    return ticks_between(low_, high_, axis_.logarithmic, std::max(1, static_cast<int>(std::abs(end_ - begin_) / room)));
  }

 private:
  const ChartAxis& axis_;
  double begin_;
  double end_;
  double low_ = 0;
  double high_ = 1;
};

void check_chart(const Chart& chart) {
  if (chart.points.empty()) throw std::invalid_argument("a chart without points cannot be drawn");
  for (const ChartPoint& point : chart.points)
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || point.series >= chart.series.size())
      throw std::invalid_argument(fmt::format("point '{}' of a chart is not finite, or of no series", point.value));
}

std::vector<double> values_of(const Chart& chart, double ChartPoint::*at,
                              std::optional<Interval> ChartPoint::*interval) {
  std::vector<double> values;
  for (const ChartPoint& point : chart.points) {
    values.push_back(point.*at);
    if (point.*interval) values.insert(values.end(), {(point.*interval)->low, (point.*interval)->high});
  }
  return values;
}

double left_room(const Chart& chart) {
  double longest = 5 * ChartLayout::letter * ChartLayout::text_size;
  for (const std::string& name : chart.y.categories)
    longest = std::max(longest, text_width(shortened(name, ChartLayout::longest_name)));
  return longest + 12 + (chart.y.title.empty() ? 0 : 18);
}

/// Of the series with names: where each entry begins, and how many lines there are.
struct Legend {
  std::vector<std::pair<double, double>> places;
  double height = 0;

  Legend(const Chart& chart, double left) {
    double x = left;
    double line = 0;
    for (const ChartSeries& series : chart.series) {
      const double entry = text_width(series.name) + 30;
      if (x > left && x + entry > ChartLayout::width) {
        x = left;
        ++line;
      }
      places.emplace_back(x, line * ChartLayout::legend_line);
      x += entry;
      height = (line + 1) * ChartLayout::legend_line;
    }
  }
};

}  // namespace

std::string chart_svg(const Chart& chart) {
  check_chart(chart);
  const double left = left_room(chart);
  const double height = chart.y.categories.empty()
                            ? ChartLayout::plain_height
                            : (chart.y.categories.size() < ChartLayout::many_names ? ChartLayout::row_height
                                                                                   : ChartLayout::dense_row_height) *
                                  static_cast<double>(chart.y.categories.size());
  const double bottom = ChartLayout::top + height;
  const Legend legend(chart, 8);
  std::vector<double> xs = values_of(chart, &ChartPoint::x, &ChartPoint::x_interval);
  xs.insert(xs.end(), chart.x_limits.begin(), chart.x_limits.end());
  const Scale x(chart.x, std::move(xs), left, ChartLayout::width - ChartLayout::right);
  const Scale y(chart.y, values_of(chart, &ChartPoint::y, &ChartPoint::y_interval),
                chart.y.categories.empty() ? bottom : ChartLayout::top,
                chart.y.categories.empty() ? ChartLayout::top : bottom);
  Svg svg = Svg::in_page(ChartLayout::width, bottom + ChartLayout::axis_room + legend.height + 4, chart.description);
  double widest = 0;
  for (const double tick : x.ticks(60)) widest = std::max(widest, text_width(tick_label(chart.x, tick)));
  for (const double tick : x.ticks(widest + 14)) {
    svg.rule(x.place(tick), ChartLayout::top, x.place(tick), bottom);
    svg.text(x.place(tick), bottom + 15, tick_label(chart.x, tick),
             {.size = ChartLayout::text_size, .anchor = Anchor::middle});
  }
  if (chart.y.categories.empty()) {
    for (const double tick : y.ticks(28)) {
      svg.rule(left, y.place(tick), ChartLayout::width - ChartLayout::right, y.place(tick));
      svg.text(left - 6, y.place(tick) + 4, tick_label(chart.y, tick),
               {.size = ChartLayout::text_size, .anchor = Anchor::end});
    }
  } else {
    for (std::size_t i = 0; i < chart.y.categories.size(); ++i) {
      const double at = y.place(static_cast<double>(i));
      svg.rule(left, at, ChartLayout::width - ChartLayout::right, at);
      svg.text(left - 6, at + 4, shortened(chart.y.categories[i], ChartLayout::longest_name),
               {.size = ChartLayout::text_size, .anchor = Anchor::end});
    }
  }
  if (!chart.y.title.empty())
    svg.text(12, ChartLayout::top + height / 2, chart.y.title,
             {.size = ChartLayout::text_size, .anchor = Anchor::middle, .upwards = true});
  svg.text((left + ChartLayout::width - ChartLayout::right) / 2, bottom + 33, chart.x.title,
           {.size = ChartLayout::text_size, .anchor = Anchor::middle});
  for (const double limit : chart.x_limits)
    svg.rule(x.place(limit), ChartLayout::top - 6, x.place(limit), bottom, true);
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    if (!chart.series[i].line) continue;
    std::vector<std::pair<double, double>> line;
    for (const ChartPoint& point : chart.points)
      if (point.series == i) line.emplace_back(x.place(point.x), y.place(point.y));
    if (line.size() > 1) svg.polyline(line, chart.series[i].paint);
  }
  bool open = false;  // a value
  for (const ChartPoint& point : chart.points) {
    const ChartSeries& series = chart.series[point.series];
    const Paint paint = point.paint.value_or(series.paint);
    const double px = x.place(point.x);
    const double py = y.place(point.y);
    if (!point.value.empty()) {
      if (open) svg.end_value();
      svg.begin_value(point.value);
      open = true;
    }
    if (point.x_interval)
      svg.polyline({{x.place(point.x_interval->low), py}, {x.place(point.x_interval->high), py}}, paint);
    if (point.y_interval)
      svg.polyline({{px, y.place(point.y_interval->low)}, {px, y.place(point.y_interval->high)}}, paint);
    if (point.marked) svg.mark(Mark::circle, px, py, 2 * ChartLayout::mark_size, {"currentColor"}, false);
    svg.mark(series.mark, px, py, ChartLayout::mark_size, paint, series.filled);
  }
  if (open) svg.end_value();
  const double legend_top = bottom + ChartLayout::axis_room + 12;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const ChartSeries& series = chart.series[i];
    const auto [lx, ly] = legend.places[i];
    svg.mark(series.mark, lx + 6, legend_top + ly - 4, ChartLayout::mark_size, series.paint, series.filled);
    svg.text(lx + 16, legend_top + ly, series.name, {.size = ChartLayout::text_size});
  }
  return svg.finished();
}

}  // namespace detp::validate
