#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <stdexcept>

#include "ply_header.hpp"

namespace detp::sim {

template <class Number>
[[nodiscard]] double number_of_bytes(const char* first, bool swapped) {
  std::array<char, sizeof(Number)> bytes;
  std::copy_n(first, sizeof(Number), bytes.begin());
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<Number>(bytes));
}

/// The number of size_of(type) bytes, `swapped` if they have the other order than this machine's.
[[nodiscard]] inline double ply_number(const char* first, PlyType type, bool swapped) {
  switch (type) {
    case PlyType::int8:
      return number_of_bytes<std::int8_t>(first, swapped);
    case PlyType::uint8:
      return number_of_bytes<std::uint8_t>(first, swapped);
    case PlyType::int16:
      return number_of_bytes<std::int16_t>(first, swapped);
    case PlyType::uint16:
      return number_of_bytes<std::uint16_t>(first, swapped);
    case PlyType::int32:
      return number_of_bytes<std::int32_t>(first, swapped);
    case PlyType::uint32:
      return number_of_bytes<std::uint32_t>(first, swapped);
    case PlyType::float32:
      return number_of_bytes<float>(first, swapped);
    case PlyType::float64:
      return number_of_bytes<double>(first, swapped);
  }
  throw std::logic_error("a number of an unknown type");
}

}  // namespace detp::sim
