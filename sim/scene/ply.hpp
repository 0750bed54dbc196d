#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// PLY files: ascii, binary of both byte orders, all number types, lists.
namespace detp::sim {

/// The values of one property. All types of PLY fit a double exactly.
struct PlyColumn {
  std::vector<double> values;
  std::vector<std::size_t> ends;  ///< of a list: where in `values` each row's entries end; empty for single numbers
  bool is_list = false;
};

/// The wanted columns of one element, by property name.
struct PlyRows {
  std::uint64_t rows = 0;
  std::map<std::string, PlyColumn, std::less<>> columns;

  /// The column of that name if the file has it and it is a list, or not, as asked; else nullptr.
  [[nodiscard]] const PlyColumn* column(std::string_view name, bool is_list = false) const;
};

/// Which properties to keep: by element, the names. The rest is read over.
using PlyWish = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Reads what is wanted of a PLY file: by element name, what the file has of it.
///
/// Throws FileError with the line, or with the element and its row counting from 1 ("vertex 17 of 100"): unreadable,
/// malformed, truncated, or an ascii file with more numbers than its header says. Never takes memory for more than the
/// file can hold, whatever the header says.
[[nodiscard]] std::map<std::string, PlyRows, std::less<>> read_ply(const std::string& path, const PlyWish& wish);

}  // namespace detp::sim
