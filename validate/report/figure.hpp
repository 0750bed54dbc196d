#pragma once

#include <string>
#include <vector>

/// A chart in a page, with its finding as caption and its table.
namespace detp::validate {

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
