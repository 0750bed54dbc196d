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
#include "mcpl_file.hpp"
#include "npz.hpp"
#include "ply.hpp"
#include "table_file.hpp"

namespace detp::sim {
namespace {

std::size_t read_ply_table(const std::string& path, const ColumnChoice& choice, const TableSink& sink,
                           std::stop_token stop) {
  PlyFile file(path, std::move(stop));
  const PlyElement& element = element_of_rows(path, file.elements());
  const std::vector<std::string> names = choice.known(path, element.names());
  const std::vector<TableColumn> columns = choice(path, names);
  choice.sort_out(path, names, columns);
  TableRow row(path, columns);
  PlyRequest request{.element = element.name, .properties = {}, .on_row = {}};
  std::vector<std::size_t> given;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (const auto property = element.number(columns[i].name, names)) {
      request.properties.push_back(*property);
      given.push_back(i);
    } else if (columns[i].absent) {
      row.set_absent(i);
    } else {
      throw FileError(
          path, fmt::format("its element {} has no property {}{}", element.name, columns[i].name, columns[i].remedy));
    }
  }
  request.on_row = [&](std::uint64_t number, const PlyValues& values) {
    for (std::size_t i = 0; i < given.size(); ++i) row.set(given[i], values[i].front());
    row.place(number + 1, element.rows, element.name);
    sink(row);
  };
  file.read({request});
  return element.rows;
}

}  // namespace

std::vector<TableColumn> ColumnChoice::operator()(const std::string& path,
                                                  const std::vector<std::string>& headings) const {
  try {
    std::vector<TableColumn> columns = choose_(headings);
    for (TableColumn& column : columns)
      column.opposite =
          std::ranges::any_of(names_, [&](const ColumnName& one) { return one.opposite && one.name == column.name; });
    return columns;
  } catch (const std::invalid_argument& error) {
    throw FileError(path, error.what());
  }
}

std::vector<std::string> ColumnChoice::known(const std::string& path, std::vector<std::string> headings) const {
  const std::vector<std::string> of_file = headings;
  for (std::string& heading : headings)
    if (std::ranges::any_of(names_, [&](const ColumnName& one) { return same_heading(one.name, heading); }))
      heading = "(" + heading + ")";
  for (const ColumnName& one : names_) {
    const auto found =
        std::ranges::find_if(of_file, [&](const std::string& heading) { return same_heading(heading, one.heading); });
    if (found == of_file.end())
      throw FileError(path, fmt::format("has no column {}, which --columns names; it has {}", detp::quoted(one.heading),
                                        of_file.empty() ? "no names of columns"
                                                        : detp::shortened(fmt::format("{}", fmt::join(of_file, " ")))));
    headings[static_cast<std::size_t>(found - of_file.begin())] = one.name;
  }
  return headings;
}

std::vector<std::string> ColumnChoice::numbered(std::size_t columns) const {
  const auto is_number = [](const ColumnName& one) {
    return std::ranges::all_of(one.heading, [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  std::vector<std::string> numbers;
  if (names_.empty() || !std::ranges::all_of(names_, is_number)) return numbers;
  for (std::size_t i = 1; i <= columns; ++i) numbers.push_back(std::to_string(i));
  return numbers;
}

std::vector<ColumnName> parse_column_names(std::string_view text) {
  std::vector<ColumnName> names;
  for (const auto& [name, heading] : parse_pairs(text, "columns must be NAME=HEADING, as in ox=px,dx=-wx")) {
    const bool opposite = heading.starts_with('-') && heading.size() > 1;
    names.push_back({name, heading.substr(opposite ? 1 : 0), opposite});
    for (std::size_t i = 0; i + 1 < names.size(); ++i)
      if (names[i].name == name || same_heading(names[i].heading, names.back().heading))
        throw std::invalid_argument(fmt::format("--columns names {} twice", names[i].name == name ? name : heading));
  }
  return names;
}

std::vector<std::pair<std::string, std::string>> parse_pairs(std::string_view text, std::string_view rule) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t end = 0; end != std::string_view::npos;
       text.remove_prefix(end == std::string_view::npos ? 0 : end + 1)) {
    end = text.find(',');
    const std::string_view one = text.substr(0, end);
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == one.size())
      throw std::invalid_argument(fmt::format("{} (got {})", rule, detp::quoted(one)));
    pairs.emplace_back(one.substr(0, equals), one.substr(equals + 1));
  }
  return pairs;
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
    const bool displaced = heading.starts_with('(');  // by a name of --columns
    unused_.push_back(displaced ? heading.substr(1, heading.size() - 2) : heading);
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
  if (has_ending(without_gz(path), ".mcpl")) return read_mcpl(path, choice, sink, std::move(stop));
  if (has_ending(path, ".npz")) return read_npz(path, choice, sink, std::move(stop));
  if (has_ending(path, ".npy.gz")) throw FileError(path, "is compressed; .npy is read as it is: unpack it first");
  return has_ending(without_gz(path), ".ply") ? read_ply_table(path, choice, sink, std::move(stop))
                                              : read_csv(path, choice, sink, std::move(stop));
}

}  // namespace detp::sim
