#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "screen.hpp"

/// Tables for a reader: columns that line up and fit the screen.
namespace detp::cli {

enum class Align { left, right };

/// A column of a text table.
struct TextColumn {
  std::string head = {};
  Align align = Align::right;
  int spare = 0;           ///< 0: always shown; else the columns with the largest number are left out first
  std::string group = {};  ///< stands above neighbouring columns that share it
};

struct TextCell {
  std::string text = {};
  Style style = Style::plain;
};

class TextTable {
 public:
  explicit TextTable(std::vector<TextColumn> columns) : columns_(std::move(columns)) {}

  /// Appends a row: a cell for each column; those that are missing at its end are empty.
  void add(std::vector<TextCell> cells);

  /// The lines. Where they would be wider than the screen, columns are left out, and a last line names them. A column
  /// without any text is not shown.
  [[nodiscard]] std::string text(const Screen& screen) const;

 private:
  [[nodiscard]] std::vector<std::size_t> widths() const;
  [[nodiscard]] std::string group_line(const std::vector<std::size_t>& shown,
                                       const std::vector<std::size_t>& widths) const;

  std::vector<TextColumn> columns_;
  std::vector<std::vector<TextCell>> rows_;
};

}  // namespace detp::cli
