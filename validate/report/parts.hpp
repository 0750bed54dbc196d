#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/model/vocabulary/technique.hpp"
#include "detp/validate/base/json.hpp"
#include "detp/validate/picture/chart.hpp"

/// The sections of the page of `detp report`, and what they are made of: what they read in the report's JSON, tables and charts as HTML.
namespace detp::validate {

/// The answer of the part with this name; null if the part was not made.
[[nodiscard]] const Json& answer_of(const Json& report, std::string_view part);

/// The number at the key; nothing if there is none, or null.
[[nodiscard]] std::optional<double> number(const Json& json, std::string_view key);

/// The text at the key; empty if there is none, or null.
[[nodiscard]] std::string words(const Json& json, std::string_view key);

/// The array or object at the key; an empty array if there is none.
[[nodiscard]] const Json& list(const Json& json, std::string_view key);

/// "fan-out 8, leaf 16" of a candidate's parameters.
[[nodiscard]] std::string parameter_words(const Json& candidate);

/// Colour and CSS class of a technique; grey for an unknown name.
[[nodiscard]] Paint paint_of(std::string_view technique);

/// "7.8 ms ± 1.6 ms".
[[nodiscard]] std::string seconds_words(double seconds, std::optional<double> error = {});

/// The number at the key as `label` writes it; `otherwise` if there is none.
[[nodiscard]] std::string shown(const Json& json, std::string_view key, std::string (*label)(double),
                                const std::string& otherwise = "");
/// The seconds at the key, ± those at `error`; empty if there are none.
[[nodiscard]] std::string shown_seconds(const Json& json, std::string_view key, std::string_view error);

/// "1.02", "0.31": a ratio with three digits.
[[nodiscard]] std::string ratio_words(std::optional<double> ratio);

/// 85 967 as "85 967"; from 10⁷ on "3.1e7".
[[nodiscard]] std::string count_words(double count);

struct Rows {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> cells = {};

  /// "box-tree: predicted 7.8 ms, measured 7.9 ms": what a point of the chart that belongs to the last row says. Empty cells are left out.
  [[nodiscard]] std::string last_words() const;
};

[[nodiscard]] std::string table_html(const std::string& title, const Rows& rows);

/// <figure> with the SVG, the finding, a place for values, and the table behind a heading that opens it. `title` must differ within a page.
[[nodiscard]] std::string figure_html(const std::string& title, const std::string& finding, const std::string& svg,
                                      const Rows& rows);

/// A table, and a chart of its rows, so that both say the same.
struct Figure {
  Rows rows;
  Chart chart;
  bool said = false;  ///< the last row has a point

  /// A new name on the chart's axis of names: its place.
  double name(const std::string& name) {
    chart.y.categories.push_back(name);
    return static_cast<double>(chart.y.categories.size() - 1);
  }
  /// Begins a row of the table.
  void row(std::vector<std::string> cells) {
    rows.cells.push_back(std::move(cells));
    said = false;
  }
  /// A point of the last row. The first one says the row in words.
  ChartPoint& point(std::size_t series, double x, double y);

  [[nodiscard]] std::string html(const std::string& title, const std::string& finding) const {
    return figure_html(title, finding, chart_svg(chart), rows);
  }
};

/// A paragraph.
[[nodiscard]] std::string paragraph(const std::string& text);

/// <section> with a heading of the second level.
[[nodiscard]] std::string section_html(const std::string& title, const std::string& body);

// The sections of a page, from the JSON of a report. A section says so where its part was not made.

/// Seconds of each technique, predicted and measured.
[[nodiscard]] std::string choice_section(const Json& report);

/// The fastest technique for other numbers of rays and other radii.
[[nodiscard]] std::string map_section(const Json& report);

/// Error against time of each estimator.
[[nodiscard]] std::string accuracy_section(const Json& report);

/// Predicted over counted tests, and over measured seconds.
[[nodiscard]] std::string comparison_section(const Json& report);

/// Verdicts on the closed forms.
[[nodiscard]] std::string verdict_section(const Json& report);

/// Evidence of each effect, and its threshold.
[[nodiscard]] std::string effects_section(const Json& report);

}  // namespace detp::validate
