#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detp/validate/picture/labels.hpp"

namespace detp::validate {
namespace {

const Json nothing;
const Json no_items = Json::array();

const Json& member(const Json& json, std::string_view key) {
  if (!json.is_object()) return nothing;
  const auto found = json.find(std::string(key));
  return found == json.end() ? nothing : *found;
}

}  // namespace

const Json& answer_of(const Json& report, std::string_view part) {
  for (const Json& one : list(report, "parts"))
    if (words(one, "name") == part) return member(one, "answer");
  return nothing;
}

std::optional<double> number(const Json& json, std::string_view key) {
  const Json& value = member(json, key);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::string words(const Json& json, std::string_view key) {
  const Json& value = member(json, key);
  return value.is_string() ? value.get<std::string>() : "";
}

const Json& list(const Json& json, std::string_view key) {
  const Json& value = member(json, key);
  return value.is_structured() ? value : no_items;
}

std::string parameter_words(const Json& candidate) {
  std::string text;
  for (const auto& [key, value] : list(candidate, "parameters").items()) {
    std::string name = key;
    std::ranges::replace(name, '_', '-');
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name,
                        value.is_string()         ? value.get<std::string>()
                        : value.is_number_float() ? fmt::format("{:.3g}", value.get<double>())
                                                  : value.dump());
  }
  return text;
}

Paint paint_of(std::string_view technique) {
  const auto known = technique_named(technique);
  return known ? Paint{colour_of(*known), name(*known)} : Paint{"#888888"};
}

std::string seconds_words(double seconds, std::optional<double> error) {
  if (!error || !(*error > 0)) return seconds_label(seconds);
  return fmt::format("{} ± {}", seconds_label(seconds), seconds_label(*error));
}

std::string shown(const Json& json, std::string_view key, std::string (*label)(double), const std::string& otherwise) {
  const auto value = number(json, key);
  return value ? label(*value) : otherwise;
}

std::string shown_seconds(const Json& json, std::string_view key, std::string_view error) {
  const auto seconds = number(json, key);
  return seconds ? seconds_words(*seconds, number(json, error)) : "";
}

std::string ratio_words(std::optional<double> ratio) { return ratio ? fmt::format("{:.3g}", *ratio) : ""; }

std::string count_words(double count) {
  if (count >= 1e7) return rays_label(count);
  std::string digits = fmt::format("{:.0f}", count);
  for (std::size_t i = digits.size(); i > 3;) digits.insert(i -= 3, "\u202f");
  return digits;
}

std::string Rows::last_words() const {
  const std::vector<std::string>& last = cells.back();
  std::string rest;
  for (std::size_t i = 1; i < head.size(); ++i)
    if (!last.at(i).empty()) rest += fmt::format("{}{} {}", rest.empty() ? ": " : ", ", head[i], last[i]);
  return last.at(0) + rest;
}

ChartPoint& Figure::point(std::size_t series, double x, double y) {
  chart.points.push_back({.series = series, .x = x, .y = y, .value = said ? "" : rows.last_words()});
  said = true;
  return chart.points.back();
}

std::string table_html(const std::string& title, const Rows& rows) {
  std::string html =
      fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table>\n<thead><tr>",
                  xml_text("Table: " + title));
  for (const std::string& one : rows.head) html += fmt::format("<th scope=\"col\">{}</th>", xml_text(one));
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows.cells) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      html += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", xml_text(row[i]))
                     : fmt::format("<td>{}</td>", xml_text(row[i]));
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table></div>\n";
}

std::string figure_html(const std::string& title, const std::string& finding, const std::string& svg,
                        const Rows& rows) {
  return fmt::format(
      "<figure>\n<figcaption>{1}</figcaption>\n"
      "<div class=\"chart\" tabindex=\"0\" role=\"group\" aria-label=\"{0}. The arrow keys read its "
      "values.\">\n{2}</div>\n"
      "<output></output>\n<details><summary>Table: {0}</summary>\n{3}</details>\n</figure>\n",
      xml_text(title), xml_text(finding), svg, table_html(title, rows));
}

std::string paragraph(const std::string& text) { return fmt::format("<p>{}</p>\n", xml_text(text)); }

std::string section_html(const std::string& title, const std::string& body) {
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", xml_text(title), body);
}

}  // namespace detp::validate
