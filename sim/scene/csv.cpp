#include "csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "file_error.hpp"
#include "input_file.hpp"
#include "number_text.hpp"

namespace detp::sim {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// A field as a message can show it: on one line and not too long.
std::string shown(std::string_view field) {
  constexpr std::size_t longest = 30;
  std::string text(field.substr(0, longest));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return '"' + text + (field.size() > longest ? "...\"" : "\"");
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (auto count = std::count(line.begin(), line.end(), ',') + 1; count > 0; --count)
    fields.push_back(trimmed(cut_until(line, ",")));
  return fields;
}

class CsvReader {
 public:
  CsvReader(const std::string& path, const std::vector<TableColumn>& columns, std::string_view content)
      : content_(content), table_{.path = path, .columns = columns, .values = {}, .lines = {}} {
    if (content_.starts_with(byte_order_mark)) content_.remove_prefix(byte_order_mark.size());
    table_.values.resize(columns.size());
  }

  Table read() {
    if (!next_line()) throw FileError(table_.path, "is empty; wanted is a header " + known_names());
    read_header();
    while (next_line()) read_row();
    for (std::size_t i = 0; i < table_.columns.size(); ++i)
      if (!is_given(i)) table_.values[i].assign(table_.rows, *table_.columns[i].absent);
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(table_.path, line_number_, what); }

  [[nodiscard]] std::string known_names() const {
    std::vector<std::string_view> names;
    for (const TableColumn& column : table_.columns) names.push_back(column.name);
    return fmt::format("{}", fmt::join(names, ","));
  }

  [[nodiscard]] bool is_given(std::size_t column) const {
    return std::find(order_.begin(), order_.end(), column) != order_.end();
  }

  /// To the next line that is not blank; false at the end.
  bool next_line() {
    while (!content_.empty()) {
      line_ = cut_until(content_, "\n");
      if (line_.ends_with('\r')) line_.remove_suffix(1);
      ++line_number_;
      if (!trimmed(line_).empty()) return true;
    }
    return false;
  }

  void read_header() {
    for (const std::string_view name : fields_of(line_)) {
      const auto known = std::find_if(table_.columns.begin(), table_.columns.end(),
                                      [name](const TableColumn& column) { return column.name == name; });
      if (known == table_.columns.end())
        fail(fmt::format("unknown column {}; known are {}", shown(name), known_names()));
      const auto column = static_cast<std::size_t>(known - table_.columns.begin());
      if (is_given(column)) fail(fmt::format("column {} is there twice", name));
      order_.push_back(column);
    }
    for (std::size_t i = 0; i < table_.columns.size(); ++i)
      if (!is_given(i) && !table_.columns[i].absent)
        fail(fmt::format("the header has no column {}{}; known are {}", table_.columns[i].name,
                         table_.columns[i].remedy, known_names()));
  }

  void read_row() {
    const std::vector<std::string_view> fields = fields_of(line_);
    if (fields.size() != order_.size())
      fail(fmt::format("{} fields, but the header has {} columns", fields.size(), order_.size()));
    for (std::size_t i = 0; i < fields.size(); ++i)
      table_.values[order_[i]].push_back(number(table_.columns[order_[i]], fields[i]));
    table_.lines.push_back(line_number_);
    ++table_.rows;
  }

  [[nodiscard]] double number(const TableColumn& column, std::string_view field) const {
    if (field.empty() && column.empty) return *column.empty;
    if (field.empty()) fail(fmt::format("{} is empty; a number is needed", column.name));
    if (const auto value = number_in(field)) return *value;
    fail(fmt::format("{} is {}, which is not a number", column.name, shown(field)));
  }

  std::string_view content_;
  std::string_view line_;
  std::size_t line_number_ = 0;
  std::vector<std::size_t> order_;  ///< of the file's columns: their places among the known ones
  Table table_;
};

}  // namespace

Table read_csv(const std::string& path, const std::vector<TableColumn>& columns) {
  const std::string content = read_file(path);
  return CsvReader(path, columns, content).read();
}

}  // namespace detp::sim
