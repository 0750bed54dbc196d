#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "input_file.hpp"
#include "number_bytes.hpp"

/// The header of a file of NumPy (.npy): one array, with one row for each ray or disc.
namespace detp::sim {

/// A number of each row.
struct NpyField {
  std::string name;  ///< of a structured array; empty in an array of plain numbers
  NumberType type = NumberType::float64;
  std::size_t offset = 0;  ///< in the row, bytes
  bool swapped = false;    ///< the bytes have the other order than this machine's
};

struct NpyHeader {
  std::uint64_t rows = 0;
  std::size_t row_size = 0;      ///< bytes
  std::vector<NpyField> fields;  ///< a structured array's, or the columns of a plain one
};

/// Reads the header from the front of a file, and leaves the position at the first row. Throws FileError for other files, arrays
/// that are neither structured with one dimension nor plain with two, that are in Fortran order, or whose numbers are no integers or floats of 1 to 8 bytes.
[[nodiscard]] NpyHeader read_npy_header(InputFile& file);

/// The same of a whole file in memory; `begin` is where its rows begin. A plain array may have one dimension, that of a column.
[[nodiscard]] NpyHeader npy_header_in(std::string_view bytes, const std::string& path, std::size_t& begin);

struct NpyColumn {
  std::string_view name;
  std::string_view type = "<f8";
};

/// The header of a structured array.
[[nodiscard]] std::string npy_header(const std::vector<NpyColumn>& columns, std::uint64_t rows);

}  // namespace detp::sim
