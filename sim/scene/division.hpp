#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "clip.hpp"
#include "detp/sim/base/stop_check.hpp"

namespace detp::sim {

/// A triangle in a polygon's plane that says what becomes of the part that it covers.
struct Cover {
  static constexpr std::uint32_t removed = UINT32_MAX;

  FlatTriangle triangle;
  std::uint32_t label;  ///< of the covered part; `removed`: it goes
};

/// A part of a polygon: a convex piece with the label of the first triangle that covers it.
struct LabelledPiece {
  FlatPolygon polygon;
  std::uint32_t label;
};

struct Division {
  std::vector<LabelledPiece> pieces;  ///< the polygon itself if nothing is removed and all has one label
  bool is_less = false;               ///< something is removed
};

/// Divides a convex polygon. Where triangles overlap each other, the first of them counts; what none covers has the label
/// `rest`. Overlaps and pieces that are no wider than the slack are none. Many triangles are handled in halves of the
/// polygon: cost O(n log n) for small triangles.
[[nodiscard]] Division divided(const FlatPolygon& polygon, std::span<const Cover> covers, std::uint32_t rest,
                               double slack, StopCheck& check);

}  // namespace detp::sim
