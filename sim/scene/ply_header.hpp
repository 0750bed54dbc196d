#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The header of a PLY file: what its body holds, and how.
namespace detp::sim {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size of one number in a binary file, bytes.
[[nodiscard]] std::size_t size_of(PlyType type);

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  ///< of the number of entries in front of a list; none: a single number
};

/// One kind of rows.
struct PlyElement {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;   ///< bytes up to the body
  std::size_t lines = 0;  ///< lines up to the body
};

/// Reads the header at the front of a file's content. Throws FileError with the line.
[[nodiscard]] PlyHeader read_ply_header(const std::string& path, std::string_view content);

}  // namespace detp::sim
