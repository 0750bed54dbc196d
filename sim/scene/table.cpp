#include "table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "csv.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "ply.hpp"

namespace detp::sim {
namespace {

Table read_ply_table(const std::string& path, const std::vector<TableColumn>& columns) {
  PlyWish wish;
  for (const TableColumn& column : columns) wish["vertex"].emplace_back(column.name);
  const auto elements = read_ply(path, wish);
  const auto vertex = elements.find("vertex");
  if (vertex == elements.end()) throw FileError(path, "has no element vertex");
  Table table{.path = path, .columns = columns, .values = {}, .lines = {}, .rows = vertex->second.rows};
  for (const TableColumn& column : columns) {
    if (const PlyColumn* given = vertex->second.column(column.name))
      table.values.push_back(given->values);
    else if (column.absent)
      table.values.emplace_back(table.rows, *column.absent);
    else
      throw FileError(path, fmt::format("its element vertex has no property {}{}", column.name, column.remedy));
  }
  return table;
}

}  // namespace

void Table::fail(std::size_t row, const std::string& what) const {
  if (lines.empty()) throw FileError(path, fmt::format("vertex {} of {}: {}", row + 1, rows, what));
  throw FileError(path, lines[row], what);
}

double Table::finite(std::size_t row, std::size_t column) const {
  const double value = values[column][row];
  if (!std::isfinite(value)) fail(row, fmt::format("{} must be finite (got {})", columns[column].name, value));
  return value;
}

glm::dvec3 Table::finite_vector(std::size_t row, std::size_t first_column) const {
  return {finite(row, first_column), finite(row, first_column + 1), finite(row, first_column + 2)};
}

Table read_table(const std::string& path, const std::vector<TableColumn>& columns) {
  return has_ending(path, ".ply") ? read_ply_table(path, columns) : read_csv(path, columns);
}

}  // namespace detp::sim
