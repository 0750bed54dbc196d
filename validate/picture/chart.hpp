#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/model/vocabulary/technique.hpp"
#include "svg.hpp"

/// Charts as pictures in a page: points with intervals over two axes, and tables of techniques.
namespace detp::validate {

struct Interval {
  double low = 0;
  double high = 0;
};

struct ChartAxis {
  std::string title = {};
  bool logarithmic = true;
  std::vector<std::string> categories = {};      ///< not empty: the axis has names; point i of it is at the value i
  std::string (*label)(double value) = nullptr;  ///< of ticks; null: "0.1"
};

/// Points of one kind, in the order of their line if there is one.
struct ChartSeries {
  std::string name;  ///< in the legend
  Paint paint;
  Mark mark = Mark::circle;
  bool line = false;
  bool filled = true;
};

struct ChartPoint {
  std::size_t series = 0;
  double x = 0;
  double y = 0;
  std::string value =
      {};  ///< in words, for the pointer and for the arrow keys; empty: the point belongs to the one before
  std::optional<Interval> x_interval = {};
  std::optional<Interval> y_interval = {};
  std::optional<Paint> paint = {};  ///< instead of that of the series
  bool marked = false;              ///< ringed: the answer
};

struct Chart {
  std::string description;  ///< what is drawn, for those who do not see it
  ChartAxis x = {};
  ChartAxis y = {};
  std::vector<ChartSeries> series = {};
  std::vector<ChartPoint> points = {};
  std::vector<double> x_limits = {};  ///< dashed lines across the picture
};

/// The chart as SVG of 440 points width, text of 12 points; values of the points in their order. Points that a logarithmic axis cannot show
/// (not above 0) are at its lower end. Throws std::invalid_argument for a chart without points, and for a point that is not finite or of no
/// series.
[[nodiscard]] std::string chart_svg(const Chart& chart);

/// What a cell of a table of techniques shows.
struct ZoneCell {
  Technique technique;
  std::string value;    ///< in words
  std::string seconds;  ///< second line; may be empty
  bool framed = false;
};

/// Cells of techniques: rows from above, columns from the left.
struct ZoneChart {
  std::string description;
  std::string x_title;
  std::string y_title;
  std::vector<std::string> columns;
  std::vector<std::string> rows;
  std::vector<std::vector<std::optional<ZoneCell>>> cells;
};

/// The same size of text as chart_svg, with a legend of the techniques. Throws std::invalid_argument for a chart without cells.
[[nodiscard]] std::string zone_svg(const ZoneChart& chart);

}  // namespace detp::validate
