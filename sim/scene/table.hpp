#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Files of numbers in named columns: CSV, or the vertices of a PLY file.
namespace detp::sim {

/// A column that a file may or must have.
struct TableColumn {
  std::string_view name;
  std::optional<double> absent;  ///< stands for a column that the file does not have; none: it must have it
  std::optional<double> empty;   ///< stands for an empty field of a CSV file; none: no field may be empty
  std::string_view remedy = {};  ///< what a message about its lack says further: ", and none is given"
};

/// What such a file holds.
struct Table {
  std::string path;
  std::vector<TableColumn> columns;
  std::vector<std::vector<double>> values;  ///< by column, then by row
  std::vector<std::size_t> lines;           ///< by row; empty for PLY
  std::size_t rows = 0;

  /// Throws FileError that names the row: by its line, or for PLY by its number among the vertices, from 1.
  [[noreturn]] void fail(std::size_t row, const std::string& what) const;

  /// Throws FileError where the number is infinite or NaN.
  [[nodiscard]] double finite(std::size_t row, std::size_t column) const;

  /// The three columns from the given one on, likewise.
  [[nodiscard]] glm::dvec3 finite_vector(std::size_t row, std::size_t first_column) const;
};

/// Reads a table: PLY where the path ends in .ply, in any case, else CSV. Throws FileError with the line (CSV) or the
/// vertex (PLY): unreadable, malformed, a column missing; see read_csv and read_ply. A table without rows is none.
[[nodiscard]] Table read_table(const std::string& path, const std::vector<TableColumn>& columns);

}  // namespace detp::sim
