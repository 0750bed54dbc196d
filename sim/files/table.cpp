#include "table.hpp"

#include <fmt/format.h>

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "csv.hpp"
#include "detp/model/vocabulary/quoted.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "ply.hpp"
#include "table_file.hpp"

namespace detp::sim {
namespace {

std::size_t read_ply_table(const std::string& path, const ColumnChoice& choice, const TableSink& sink,
                           std::stop_token stop) {
  PlyFile file(path, std::move(stop));
  const PlyElement* vertex = file.element("vertex");
  if (vertex == nullptr) throw FileError(path, "has no element vertex");
  std::vector<std::string> names;
  for (const PlyProperty& property : vertex->properties) names.push_back(property.name);
  const std::vector<TableColumn> columns = choice(path, names);
  choice.sort_out(path, names, columns);
  TableRow row(path, columns);
  PlyRequest request{.element = "vertex", .properties = {}, .on_row = {}};
  std::vector<std::size_t> given;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (const auto property = vertex->property(columns[i].name, false)) {
      request.properties.push_back(*property);
      given.push_back(i);
    } else if (columns[i].absent) {
      row.set_absent(i);
    } else {
      throw FileError(path, fmt::format("its element vertex has no property {}{}", columns[i].name, columns[i].remedy));
    }
  }
  request.on_row = [&](std::uint64_t number, const PlyValues& values) {
    for (std::size_t i = 0; i < given.size(); ++i) row.set(given[i], values[i].front());
    row.place(number + 1, vertex->rows);
    sink(row);
  };
  file.read({request});
  return vertex->rows;
}

}  // namespace

std::vector<TableColumn> ColumnChoice::operator()(const std::string& path,
                                                  const std::vector<std::string>& headings) const {
  try {
    return choose_(headings);
  } catch (const std::invalid_argument& error) {
    throw FileError(path, error.what());
  }
}

bool same_heading(std::string_view one, std::string_view other) {
  return std::ranges::equal(
      one, other, {}, [](unsigned char c) { return std::tolower(c); }, [](unsigned char c) { return std::tolower(c); });
}

void ColumnChoice::sort_out(const std::string& path, const std::vector<std::string>& headings,
                            const std::vector<TableColumn>& columns) const {
  if (const std::string wrong = sort_out(headings, columns); !wrong.empty()) throw FileError(path, wrong);
}

std::string ColumnChoice::sort_out(const std::vector<std::string>& headings,
                                   const std::vector<TableColumn>& columns) const {
  unused_.clear();
  std::vector<std::string_view> missing;
  for (const TableColumn& column : columns)
    if (std::ranges::none_of(headings, [&](const std::string& one) { return same_heading(one, column.name); }))
      missing.push_back(column.name);
  for (const std::string& heading : headings) {
    if (std::ranges::any_of(columns, [&](const TableColumn& one) { return same_heading(one.name, heading); })) continue;
    constexpr std::size_t shortest = 4;  // shorter ones are near to too many
    const std::string meant = heading.size() >= shortest ? did_you_mean(heading, missing) : "";
    if (!meant.empty()) return fmt::format("unknown column {}{}", detp::quoted(heading), meant);
    unused_.push_back(heading);
  }
  return "";
}

std::string unused_notice(const std::string& path, const std::vector<std::string>& unused) {
  if (unused.empty()) return "";
  constexpr std::size_t most = 10;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(most, unused.size()); ++i) names.push_back(detp::quoted(unused[i]));
  return fmt::format("{}: {} {}{} not used", shown_path(path), unused.size() == 1 ? "column" : "columns",
                     fmt::join(names, ", "),
                     unused.size() > most ? fmt::format(" and {} others are", unused.size() - most)
                     : unused.size() == 1 ? " is"
                                          : " are");
}

void TableRow::fail(const std::string& what) const {
  if (rows_ > 0) throw FileError(path_, fmt::format("{} {} of {}: {}", what_, number_, rows_, what));
  throw FileError(path_, number_, what);
}

double TableRow::finite(std::size_t column) const {
  const double value = values_[column];
  if (!std::isfinite(value)) fail(fmt::format("{} must be finite (got {})", columns_[column].name, value));
  return value;
}

glm::dvec3 TableRow::finite_vector(std::size_t first_column) const {
  return {finite(first_column), finite(first_column + 1), finite(first_column + 2)};
}

std::size_t read_table(const std::string& path, const ColumnChoice& choice, const TableSink& sink,
                       std::stop_token stop) {
  if (const auto table = TableFile::open(path, choice)) {
    table->read(0, table->rows(), sink, stop);
    return table->rows();
  }
  if (has_ending(path, ".npy.gz")) throw FileError(path, "is compressed; .npy is read as it is: unpack it first");
  return has_ending(without_gz(path), ".ply") ? read_ply_table(path, choice, sink, std::move(stop))
                                              : read_csv(path, choice, sink, std::move(stop));
}

}  // namespace detp::sim
