#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"
#include "text_table.hpp"

namespace detp::cli {
namespace {

std::string text_csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string csv_field(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return text_csv_field(value.get_ref<const std::string&>());
  if (!value.is_number_float()) return value.dump();
  const auto number = value.get<double>();
  return std::isfinite(number) ? fmt::format("{}", number) : "";
}

std::string text_field(const Json& row, const std::string& column) {
  if (!row.contains(column)) return "";
  const Json& value = row[column];
  if (value.is_null()) return "";
  if (value.is_string()) return escaped(value.get<std::string>());
  return value.is_number_float() ? fmt::format("{:.6g}", value.get<double>()) : value.dump();
}

template <class Fields, class Text>
std::string csv_line(const Fields& fields, Text text) {
  std::string line;
  for (const auto& field : fields) line += (&field == &*fields.begin() ? "" : ",") + text(field);
  return line + "\n";
}

}  // namespace

Columns operator+(Columns left, const Columns& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

void Table::add(const Json& row) {
  std::vector<Json> fields(columns_.size());
  for (const auto& [name, value] : row.items()) {
    const auto column = std::find(columns_.begin(), columns_.end(), name);
    if (column == columns_.end() || value.is_structured())
      throw std::logic_error(fmt::format("a table has no column for {}", name));
    fields[static_cast<std::size_t>(column - columns_.begin())] = value;
  }
  rows_.push_back(std::move(fields));
}

std::string Table::csv() const {
  std::string csv = csv_line(columns_, text_csv_field);
  for (const std::vector<Json>& row : rows_) csv += csv_line(row, csv_field);
  return csv;
}

std::string aligned_text(const std::vector<Json>& rows, const Columns& inputs, const Columns& answers,
                         const Screen& screen) {
  std::vector<TextColumn> columns;
  std::vector<std::vector<TextCell>> cells(rows.size());
  std::string above;
  int spare = 0;
  const auto show = [&](const std::string& name, bool answer) {
    Columns fields;
    for (const Json& row : rows) fields.push_back(text_field(row, name));
    const bool same = std::adjacent_find(fields.begin(), fields.end(), std::not_equal_to<>()) == fields.end();
    if (same && (fields.empty() || fields.front().empty())) return;
    if (same && !answer) {
      above += fmt::format("{:<16} {}\n", name, fields.front());
      return;
    }
    columns.push_back({.head = name, .spare = answer ? spare++ : 0});
    for (std::size_t i = 0; i < rows.size(); ++i) cells[i].push_back({std::move(fields[i])});
  };
  for (const std::string& name : inputs) show(name, false);
  for (const std::string& name : answers) show(name, true);
  TextTable table(std::move(columns));
  for (auto& row : cells) table.add(std::move(row));
  return above + "\n" + table.text(screen);
}

std::string joined(const std::vector<std::string>& texts) { return fmt::format("{}", fmt::join(texts, "; ")); }

}  // namespace detp::cli
