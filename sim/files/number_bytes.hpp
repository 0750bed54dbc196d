#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

/// Numbers in binary files.
namespace detp::sim {

enum class NumberType { int8, uint8, int16, uint16, int32, uint32, float32, float64, int64, uint64 };

/// Size of one number, bytes.
[[nodiscard]] constexpr std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 4, 8, 8, 8};
  return sizes[static_cast<std::size_t>(type)];
}

template <class Number>
[[nodiscard]] double number_of_bytes(const char* first, bool swapped) {
  std::array<char, sizeof(Number)> bytes;
  std::copy_n(first, sizeof(Number), bytes.begin());
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<Number>(bytes));
}

/// The number of size_of(type) bytes, `swapped` if they have the other order than this machine's.
[[nodiscard]] inline double number_at(const char* first, NumberType type, bool swapped) {
  switch (type) {
    case NumberType::int8:
      return number_of_bytes<std::int8_t>(first, swapped);
    case NumberType::uint8:
      return number_of_bytes<std::uint8_t>(first, swapped);
    case NumberType::int16:
      return number_of_bytes<std::int16_t>(first, swapped);
    case NumberType::uint16:
      return number_of_bytes<std::uint16_t>(first, swapped);
    case NumberType::int32:
      return number_of_bytes<std::int32_t>(first, swapped);
    case NumberType::uint32:
      return number_of_bytes<std::uint32_t>(first, swapped);
    case NumberType::float32:
      return number_of_bytes<float>(first, swapped);
    case NumberType::float64:
      return number_of_bytes<double>(first, swapped);
    case NumberType::int64:
      return number_of_bytes<std::int64_t>(first, swapped);
    case NumberType::uint64:
      return number_of_bytes<std::uint64_t>(first, swapped);
  }
  throw std::logic_error("a number of an unknown type");
}

}  // namespace detp::sim
