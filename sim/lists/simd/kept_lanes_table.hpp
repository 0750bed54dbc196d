#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace detp::sim::stream {

/// For each set of 8 lanes, given by bits: the numbers of the lanes in the set, then those of the others, in order. The first
/// four numbers of the first 16 rows do the same for 4 lanes.
inline constexpr auto kept_lanes_table = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t bits = 0; bits < table.size(); ++bits) {
    std::size_t place = 0;
    for (const bool kept : {true, false})
      for (std::uint8_t lane = 0; lane < 8; ++lane)
        if (((bits >> lane & 1) != 0) == kept) table[bits][place++] = lane;
  }
  return table;
}();

}  // namespace detp::sim::stream
