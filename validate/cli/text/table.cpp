#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "detp/model/vocabulary/quoted.hpp"

namespace detp::cli {
namespace {

constexpr std::size_t gap = 2;

std::string padded(const TextColumn& column, const std::string& text, std::size_t width) {
  const std::string space(width - std::min(width, columns_of(text)), ' ');
  return column.align == Align::left ? text + space : space + text;
}

void trim_end(std::string& line) { line.erase(line.find_last_not_of(' ') + 1); }

std::size_t total_width(const std::vector<std::size_t>& shown, const std::vector<std::size_t>& widths) {
  std::size_t total = 0;
  for (const std::size_t i : shown) total += widths[i] + (total > 0 ? gap : 0);
  return total;
}

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

void TextTable::add(std::vector<TextCell> cells) {
  if (cells.size() > columns_.size()) throw std::logic_error("a row has more cells than its table has columns");
  cells.resize(columns_.size());
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t widest = 0;
    for (const auto& row : rows_) widest = std::max(widest, columns_of(row[i].text));
    widths.push_back(widest == 0 && !rows_.empty() ? 0 : std::max(widest, columns_of(columns_[i].head)));
  }
  return widths;
}

std::string TextTable::group_line(const std::vector<std::size_t>& shown, const std::vector<std::size_t>& widths) const {
  std::string line;
  std::size_t place = 0;
  std::string last;
  for (const std::size_t i : shown) {
    const std::string& group = columns_[i].group;
    if (!group.empty() && group != last) {
      line.resize(std::max(line.size() + (line.empty() ? 0 : 1), place), ' ');
      line += group;
    }
    last = group;
    place += widths[i] + gap;
  }
  return line.empty() ? "" : line + "\n";
}

std::string TextTable::text(const Screen& screen) const {
  const std::vector<std::size_t> widths = this->widths();
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (widths[i] > 0) shown.push_back(i);
  std::vector<std::string> left_out;
  while (screen.width > 0 && total_width(shown, widths) > screen.width) {
    const auto most = std::max_element(shown.begin(), shown.end(), [&](std::size_t a, std::size_t b) {
      return columns_[a].spare < columns_[b].spare;
    });
    if (most == shown.end() || columns_[*most].spare == 0) break;
    const TextColumn& column = columns_[*most];
    left_out.push_back(column.group.empty() ? column.head : fmt::format("{} {}", column.group, column.head));
    shown.erase(most);
  }
  std::string text = group_line(shown, widths);
  const auto add_line = [&](const auto& cell_of) {
    std::string line;
    for (const std::size_t i : shown) line += (line.empty() ? "" : std::string(gap, ' ')) + cell_of(i);
    trim_end(line);
    text += line + "\n";
  };
  add_line(
      [&](std::size_t i) { return styled(screen, Style::strong, padded(columns_[i], columns_[i].head, widths[i])); });
  for (const auto& row : rows_)
    add_line([&](std::size_t i) { return styled(screen, row[i].style, padded(columns_[i], row[i].text, widths[i])); });
  if (!left_out.empty())
    text += wrapped(fmt::format("(left out of {} columns: {}; a wider terminal or --format csv shows all)",
                                screen.width, fmt::join(left_out, ", ")),
                    screen.text_width(), 1);
  return text;
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
