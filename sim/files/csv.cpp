#include "csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "file_error.hpp"
#include "number_text.hpp"
#include "text_lines.hpp"

namespace detp::sim {
namespace {

class CsvReader {
 public:
  CsvReader(const std::string& path, const std::vector<TableColumn>& columns, std::stop_token stop)
      : file_(path, std::move(stop)), lines_(file_), row_(path, columns) {}

  std::size_t read(const TableSink& sink) {
    if (!next_line()) throw FileError(file_.path(), "is empty; expected a header " + known_names());
    read_header();
    for (std::size_t i = 0; i < row_.columns().size(); ++i)
      if (!is_given(i)) row_.set_absent(i);
    std::size_t rows = 0;
    for (; next_line(); ++rows) {
      read_row();
      sink(row_);
    }
    return rows;
  }

 private:
  [[nodiscard]] std::string known_names() const {
    std::vector<std::string_view> names;
    for (const TableColumn& column : row_.columns()) names.push_back(column.name);
    return fmt::format("{}", fmt::join(names, ","));
  }

  [[nodiscard]] bool is_given(std::size_t column) const {
    return std::find(order_.begin(), order_.end(), column) != order_.end();
  }

  /// Goes to the next line that is not blank; false at the end.
  bool next_line() {
    while (lines_.next())
      if (!trimmed(lines_.line()).empty()) return true;
    return false;
  }

  static std::size_t fields_in(std::string_view line) {
    return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
  }

  void read_header() {
    std::string_view line = lines_.line();
    for (std::size_t fields = fields_in(line); fields > 0; --fields) {
      const std::string_view name = trimmed(cut_until(line, ","));
      const auto known = std::find_if(row_.columns().begin(), row_.columns().end(),
                                      [name](const TableColumn& column) { return column.name == name; });
      if (known == row_.columns().end())
        lines_.fail(fmt::format("unknown column {}; known are {}", detp::quoted(name), known_names()));
      const auto column = static_cast<std::size_t>(known - row_.columns().begin());
      if (is_given(column)) lines_.fail(fmt::format("column {} appears twice", name));
      order_.push_back(column);
    }
    for (std::size_t i = 0; i < row_.columns().size(); ++i)
      if (!is_given(i) && !row_.columns()[i].absent)
        lines_.fail(fmt::format("the header has no column {}{}; known are {}", row_.columns()[i].name,
                                row_.columns()[i].remedy, known_names()));
  }

  void read_row() {
    std::string_view line = lines_.line();
    const std::size_t fields = fields_in(line);
    if (fields != order_.size())
      lines_.fail(fmt::format("{} fields, but the header has {} columns", fields, order_.size()));
    for (const std::size_t column : order_)
      row_.set(column, number(row_.columns()[column], trimmed(cut_until(line, ","))));
    row_.place(lines_.number());
  }

  [[nodiscard]] double number(const TableColumn& column, std::string_view field) const {
    if (field.empty() && column.empty) return *column.empty;
    if (field.empty()) lines_.fail(fmt::format("{} is empty; a number is needed", column.name));
    if (const auto value = number_in(field)) return *value;
    lines_.fail(fmt::format("{} is {}, which is not a number", column.name, detp::quoted(field)));
  }

  InputFile file_;
  TextLines lines_;
  std::vector<std::size_t> order_;  ///< for each of the file's columns, its index in row_.columns()
  TableRow row_;
};

}  // namespace

std::size_t read_csv(const std::string& path, const std::vector<TableColumn>& columns, const TableSink& sink,
                     std::stop_token stop) {
  return CsvReader(path, columns, std::move(stop)).read(sink);
}

}  // namespace detp::sim
