#pragma once

#include <algorithm>
#include <span>

#include "disc_tree.hpp"

/// Boxes around discs.
namespace detp::sim::stream {

struct FloatBox {
  float low[3];
  float high[3];

  /// Half the box's surface, which is proportional to the number of lines that cross the box.
  [[nodiscard]] float area() const {
    const float x = high[0] - low[0];
    const float y = high[1] - low[1];
    const float z = high[2] - low[2];
    return x * y + y * z + z * x;
  }
};

/// A box that holds nothing, in the frame's coordinates.
inline constexpr FloatBox nothing{{2, 2, 2}, {-2, -2, -2}};

/// The smallest box around both.
[[nodiscard]] inline FloatBox joined(const FloatBox& a, const FloatBox& b) {
  return {{std::min(a.low[0], b.low[0]), std::min(a.low[1], b.low[1]), std::min(a.low[2], b.low[2])},
          {std::max(a.high[0], b.high[0]), std::max(a.high[1], b.high[1]), std::max(a.high[2], b.high[2])}};
}

/// The smallest box around some discs. A disc of radius d and normal n reaches d √(1 - n_i²) along axis i. The same bits with every
/// instruction set.
[[nodiscard]] FloatBox box_around(std::span<const FloatDisc> discs);

}  // namespace detp::sim::stream
