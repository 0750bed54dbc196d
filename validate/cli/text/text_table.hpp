#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "screen.hpp"

/// Text tables with aligned columns, not wider than the screen.
namespace detp::cli {

enum class Align { left, right };

struct TextColumn {
  std::string head = {};
  Align align = Align::right;
  int spare = 0;           ///< 0: always shown; columns with the largest values are left out first
  std::string group = {};  ///< heading above neighbouring columns of the same group
};

struct TextCell {
  std::string text = {};
  Style style = Style::plain;
};

class TextTable {
 public:
  explicit TextTable(std::vector<TextColumn> columns) : columns_(std::move(columns)) {}

  /// Appends a row with one cell per column. Missing cells at the end of the row are empty.
  void add(std::vector<TextCell> cells);

  /// Returns the table as text. If the table is wider than the screen, it leaves columns out and names them in a last
  /// line. Columns whose cells are all empty are not shown.
  [[nodiscard]] std::string text(const Screen& screen) const;

 private:
  [[nodiscard]] std::vector<std::size_t> widths() const;
  [[nodiscard]] std::string group_line(const std::vector<std::size_t>& shown,
                                       const std::vector<std::size_t>& widths) const;

  std::vector<TextColumn> columns_;
  std::vector<std::vector<TextCell>> rows_;
};

}  // namespace detp::cli
