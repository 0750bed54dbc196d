#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "detp/validate/base/json.hpp"
#include "result.hpp"
#include "screen.hpp"

/// Tables: of text with aligned columns, not wider than the screen, and of results under declared columns.
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

using validate::Columns;
using validate::known;
using validate::operator+;

/// Rows of numbers, strings and booleans under declared columns. Missing values, null, and numbers that are not finite
/// become empty fields.
class Table {
 public:
  explicit Table(Columns columns) : columns_(std::move(columns)) {}

  /// Appends a row: a flat JSON object. Throws std::logic_error for a name that is not a column and for a nested value.
  void add(const Json& row);

  /// RFC 4180, with \n as line end: a header, then the rows. Numbers are in the shortest form that reads back to the
  /// same double.
  [[nodiscard]] std::string csv() const;

 private:
  Columns columns_;
  std::vector<std::vector<Json>> rows_;
};

/// Rows as text. The first lines have each input that is the same in all rows. A table with the other inputs and the
/// results follows. If the table is wider than the screen, results are left out, the last columns first, and a last
/// line names the columns that were left out.
[[nodiscard]] std::string aligned_text(const std::vector<Json>& rows, const Columns& inputs, const Columns& answers,
                                       const Screen& screen);

/// A list of texts as one cell, separated by "; ".
[[nodiscard]] std::string joined(const std::vector<std::string>& texts);

}  // namespace detp::cli
