#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ply_header.hpp"
#include "table.hpp"

namespace detp::sim {

/// A table whose rows can be read in any order: a binary PLY file whose vertices have no lists, or an array of NumPy. Reads by position, because a part of a mapped
/// file that cannot be read ends the program. May be used by several threads.
class TableFile {
 public:
  /// Null for any other file. Throws FileError as read_table does, if the file is shorter than its header says, and for an array that is no
  /// regular file.
  [[nodiscard]] static std::optional<TableFile> open(const std::string& path, const ColumnChoice& choice);

  ~TableFile();
  TableFile(TableFile&& other) noexcept;
  TableFile& operator=(TableFile&&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  /// Columns that were chosen, in the file or not.
  [[nodiscard]] std::size_t columns() const { return columns_.size(); }
  /// The file has the column.
  [[nodiscard]] bool given(std::size_t column) const { return places_[column].has_value(); }

  /// Passes on the rows first … last - 1. Throws FileError with the system's reason if they cannot be read, and Stopped.
  void read(std::uint64_t first, std::uint64_t last, const TableSink& sink, const std::stop_token& stop = {}) const;

 private:
  /// Of a column in a row.
  struct Place {
    std::size_t offset = 0;
    NumberType type = NumberType::float32;
    bool swapped = false;
  };

  explicit TableFile(std::string path) : path_(std::move(path)) {}
  /// Takes the places of the columns. False if the vertices have lists, or are text.
  bool take_ply(InputFile& file, const ColumnChoice& choice);
  void take_npy(InputFile& file, const ColumnChoice& choice);
  void open_rows(std::uint64_t rest, std::uint64_t before, std::string_view rows);

  std::string path_;
  std::vector<TableColumn> columns_;
  std::vector<std::optional<Place>> places_;  ///< of each column
  std::uint64_t rows_ = 0;
  std::uint64_t begin_ = 0;  ///< of the first row, bytes
  std::size_t row_size_ = 0;
  std::string row_name_ = "vertex";
  int descriptor_ = -1;
};

}  // namespace detp::sim
