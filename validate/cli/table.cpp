#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "workload_options.hpp"

namespace detp::cli {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string csv_field(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return quoted(value.get_ref<const std::string&>());
  if (!value.is_number_float()) return value.dump();
  const auto number = value.get<double>();
  return std::isfinite(number) ? fmt::format("{}", number) : "";
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
  std::string csv = csv_line(columns_, quoted);
  for (const std::vector<Json>& row : rows_) csv += csv_line(row, csv_field);
  return csv;
}

const Columns& workload_columns() {
  static const Columns columns{"scene",         "field",           "rays",          "samples",    "disc_radius",
                               "ray_file",      "front_facing",    "sphere_radius", "scene_side", "dimension",
                               "sample_extent", "sample_distance", "path_length"};
  return columns;
}

const Columns& candidate_columns() {
  static const Columns columns{"technique", "parameters", "ratio", "spheres", "order",   "depth",  "traversal",
                               "cells",     "fan_out",    "leaf",  "bounds",  "quality", "nearest"};
  return columns;
}

Columns count_columns(const std::string& prefix) {
  Columns columns;
  for_each_term(Counts<double>{},
                [&](std::string_view term, double) { columns.push_back(prefix + std::string(term)); });
  columns.push_back(prefix + "tests");
  return columns;
}

Json workload_cells(const Json& inputs) {
  Json cells;
  for (const std::string& column : workload_columns())
    if (inputs.contains(column)) cells[column] = inputs[column];
  return cells;
}

Json candidate_cells(const Candidate& candidate) {
  Json cells{{"technique", name(candidate.technique)}, {"parameters", describe(candidate.parameters)}};
  cells.update(to_json(candidate.parameters));
  return cells;
}

}  // namespace detp::cli
