#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input_file.hpp"
#include "number_bytes.hpp"

/// The header of a PLY file: what the file's body contains, and in which format.
namespace detp::sim {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::float32;
  std::optional<NumberType> count_type;  ///< type of the entry count in front of a list; none: a single number
};

/// One kind of row.
struct PlyElement {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<PlyProperty> properties;

  /// The place of the list (`list` true) or single number of that name. Nullopt if the element has no such property.
  [[nodiscard]] std::optional<std::size_t> property(std::string_view wanted, bool list) const;
  [[nodiscard]] std::vector<std::string> names() const;
  /// The place of the single number that one of the properties' names, as they may have been changed, is.
  [[nodiscard]] std::optional<std::size_t> number(std::string_view wanted, const std::vector<std::string>& names) const;
};

/// The one whose rows are those of a table: vertex, else photon, else the only one. Throws FileError if there is none.
[[nodiscard]] const PlyElement& element_of_rows(const std::string& path, const std::vector<PlyElement>& elements);

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;  ///< number of lines before the body
};

/// Reads the header from the front of a file, and leaves the position at the body. Throws FileError with the line if
/// the header is malformed or longer than 256 KiB; and as TextLines does.
[[nodiscard]] PlyHeader read_ply_header(InputFile& file);

}  // namespace detp::sim
