#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Files of numbers in named columns: CSV, the vertices of a PLY file, or an array of NumPy.
namespace detp::sim {

/// A column that a file may have or must have.
struct TableColumn {
  std::string name;
  std::optional<double> absent;  ///< value if the file has no such column; none: the column is required
  std::optional<double> empty;   ///< value of an empty field in a CSV file; none: no field may be empty
  std::string_view remedy = {};  ///< ends the message about a missing column, such as ", and none is given"
  bool opposite = false;         ///< the file has it with the other sign
};

/// Another name that a file has for a column.
struct ColumnName {
  std::string name;       ///< of the column
  std::string heading;    ///< in the file; of a file without headings the column's number, from 1
  bool opposite = false;  ///< and the other sign

  bool operator==(const ColumnName&) const = default;
};

/// Reads "a=b,c=d". Throws std::invalid_argument for anything else, with the rule.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> parse_pairs(std::string_view text,
                                                                           std::string_view rule);

/// Reads "ox=px,oy=py,dx=-wx". Throws std::invalid_argument for anything else, and for a name or a heading that appears twice.
[[nodiscard]] std::vector<ColumnName> parse_column_names(std::string_view text);

/// The columns to read from a file: always the same, or those that a function chooses when it knows the file's headings (none: columns
/// have no names). The function may throw std::invalid_argument, whose text becomes that of a FileError.
class ColumnChoice {
 public:
  ColumnChoice(std::vector<TableColumn> columns)
      : choose_([columns = std::move(columns)](const std::vector<std::string>&) { return columns; }) {}
  ColumnChoice(std::function<std::vector<TableColumn>(const std::vector<std::string>& headings)> choose)
      : choose_(std::move(choose)) {}

  /// The same with other names in the file.
  [[nodiscard]] ColumnChoice named(std::vector<ColumnName> names) && {
    names_ = std::move(names);
    return std::move(*this);
  }
  /// The file's headings by the names of the columns that they are. A heading that is another column's name then is none. Throws FileError if the file lacks one of the
  /// headings that are named.
  [[nodiscard]] std::vector<std::string> known(const std::string& path, std::vector<std::string> headings) const;
  /// "1", "2", … of so many columns without headings if columns are named so; else none.
  [[nodiscard]] std::vector<std::string> numbered(std::size_t columns) const;

  /// Of known headings.
  [[nodiscard]] std::vector<TableColumn> operator()(const std::string& path,
                                                    const std::vector<std::string>& headings) const;

  /// What is wrong if a heading that is no column looks like a misspelt one that the file lacks; else empty. Keeps the others for `unused`.
  [[nodiscard]] std::string sort_out(const std::vector<std::string>& headings,
                                     const std::vector<TableColumn>& columns) const;
  /// Throws FileError with it.
  void sort_out(const std::string& path, const std::vector<std::string>& headings,
                const std::vector<TableColumn>& columns) const;
  /// Headings of the file read last that are no columns, in the file's order.
  [[nodiscard]] const std::vector<std::string>& unused() const { return unused_; }

 private:
  std::function<std::vector<TableColumn>(const std::vector<std::string>&)> choose_;
  std::vector<ColumnName> names_ = {};
  mutable std::vector<std::string> unused_;
};

/// The headings are the same, in upper or lower case.
[[nodiscard]] bool same_heading(std::string_view one, std::string_view other);

/// "columns id and "wave length" are not used"; empty if there are none.
[[nodiscard]] std::string unused_notice(const std::string& path, const std::vector<std::string>& unused);

/// One row of a table.
class TableRow {
 public:
  TableRow(std::string path, std::vector<TableColumn> columns)
      : path_(std::move(path)), columns_(std::move(columns)), values_(columns_.size()), given_(columns_.size(), true) {}

  [[nodiscard]] const std::vector<TableColumn>& columns() const { return columns_; }
  [[nodiscard]] double operator[](std::size_t column) const { return values_[column]; }

  void set(std::size_t column, double value) { values_[column] = columns_[column].opposite ? -value : value; }

  /// The file has no such column: every row has its `absent` value.
  void set_absent(std::size_t column) {
    values_[column] = *columns_[column].absent;
    given_[column] = false;
  }
  /// True if the file has the column.
  [[nodiscard]] bool given(std::size_t column) const { return given_[column]; }

  /// Sets the row's place: its line in a CSV file, or its number, from 1, among the `rows` rows of another, `what` being one of them.
  void place(std::size_t number, std::size_t rows = 0, std::string_view what = "vertex") {
    number_ = number;
    rows_ = rows;
    what_ = what;
  }

  /// Rows that the file has, about; 0: not known, or not yet.
  void expect(std::size_t rows) { expected_ = rows; }
  [[nodiscard]] std::size_t expected_rows() const { return expected_; }

  /// Throws FileError with the row's place.
  [[noreturn]] void fail(const std::string& what) const;

  /// The number in the column. Throws FileError if it is infinite or NaN.
  [[nodiscard]] double finite(std::size_t column) const;

  /// The numbers in this column and the next two. Throws FileError if one is infinite or NaN.
  [[nodiscard]] glm::dvec3 finite_vector(std::size_t first_column) const;

 private:
  std::string path_;
  std::vector<TableColumn> columns_;
  std::vector<double> values_;
  std::vector<bool> given_;
  std::size_t number_ = 0;
  std::size_t rows_ = 0;  ///< 0: number_ is a line number
  std::size_t expected_ = 0;
  std::string_view what_;
};

/// Receives each row as it is read; may throw.
using TableSink = std::function<void(const TableRow&)>;

/// Reads a table row by row, in bounded memory: PLY if the path ends in .ply, an array of NumPy if it ends in .npy, several if in .npz, particles if in .mcpl (upper or lower case), else
/// CSV. Returns the number of rows. Throws FileError with the line (CSV), the vertex (PLY) or the row if the file is unreadable or malformed,
/// or a column is missing; see read_csv and PlyFile. Throws Stopped within 0.1 s of a stop request.
std::size_t read_table(const std::string& path, const ColumnChoice& choice, const TableSink& sink,
                       std::stop_token stop = {});

}  // namespace detp::sim
