#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "output_file.hpp"

namespace detp::sim {

/// Writes a number of a binary PLY file.
template <class Number>
void write_little_endian(OutputFile& file, Number number) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  file.write({bytes.data(), bytes.size()});
}

}  // namespace detp::sim
