#include "figure.hpp"

#include <fmt/format.h>

#include "detp/validate/picture/svg.hpp"

namespace detp::validate {

std::string Rows::words(std::size_t row) const {
  std::string text = cells.at(row).at(0);
  std::string rest;
  for (std::size_t i = 1; i < head.size(); ++i)
    if (const std::string& cell = cells[row].at(i); !cell.empty())
      rest += fmt::format("{}{} {}", rest.empty() ? ": " : ", ", head[i], cell);
  return text + rest;
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
