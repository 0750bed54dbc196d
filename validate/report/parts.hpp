#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "detp/model/vocabulary/technique.hpp"
#include "detp/validate/picture/svg.hpp"

/// What the sections of a page are made of: what they read in the JSON answer of `detp report`, and tables and charts as HTML.
namespace detp::validate {

using ReportJson = nlohmann::ordered_json;

/// The answer of the part with this name; null if the part was not made.
[[nodiscard]] const ReportJson& answer_of(const ReportJson& report, std::string_view part);

/// The number at the key; nothing if there is none, or null.
[[nodiscard]] std::optional<double> number(const ReportJson& json, std::string_view key);

/// The text at the key; empty if there is none, or null.
[[nodiscard]] std::string words(const ReportJson& json, std::string_view key);

/// The array or object at the key; an empty array if there is none.
[[nodiscard]] const ReportJson& list(const ReportJson& json, std::string_view key);

/// "fan-out 8, leaf 16" of a candidate's parameters.
[[nodiscard]] std::string parameter_words(const ReportJson& candidate);

/// The technique with this name; nothing for an unknown one.
[[nodiscard]] std::optional<Technique> technique_named(std::string_view name);

/// Colour and CSS class of a technique; grey for an unknown name.
[[nodiscard]] Paint paint_of(std::string_view technique);

/// "7.8 ms ± 1.6 ms".
[[nodiscard]] std::string seconds_words(double seconds, std::optional<double> error = {});

/// "1.02", "0.31": a ratio with three digits.
[[nodiscard]] std::string ratio_words(std::optional<double> ratio);

/// 85 967 as "85 967"; from 10⁷ on "3.1e7".
[[nodiscard]] std::string count_words(double count);

struct Rows {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> cells;

  /// "box-tree: predicted 7.8 ms, measured 7.9 ms": what a point of the chart that belongs to this row says. Empty cells are left out.
  [[nodiscard]] std::string words(std::size_t row) const;
};

/// <figure> with the SVG, the finding, a place for values, and the table behind a heading that opens it. `title` must differ within a page.
[[nodiscard]] std::string figure_html(const std::string& title, const std::string& finding, const std::string& svg,
                                      const Rows& rows);

[[nodiscard]] std::string table_html(const std::string& title, const Rows& rows);

/// A paragraph.
[[nodiscard]] std::string paragraph(const std::string& text);

/// <section> with a heading of the second level.
[[nodiscard]] std::string section_html(const std::string& title, const std::string& body);

}  // namespace detp::validate
