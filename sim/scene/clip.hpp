#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detp/sim/base/stop_check.hpp"

/// Convex polygons in a plane, and how a triangle cuts them. All are counter-clockwise. Lengths up to `slack` count as
/// 0, so that no slivers arise.
namespace detp::sim {

inline constexpr std::uint32_t new_corner = UINT32_MAX;

struct FlatCorner {
  glm::dvec2 place{0.0};
  std::uint32_t number = new_corner;  ///< which corner of the first polygon this is; new_corner: a cut made it
};

using FlatPolygon = std::vector<FlatCorner>;
using FlatTriangle = std::array<glm::dvec2, 3>;

/// A directed line.
struct FlatLine {
  glm::dvec2 point{0.0};
  glm::dvec2 inwards{0.0};  ///< to the left of the line, of unit length; zero if the line has no direction
};

[[nodiscard]] FlatLine line_through(const glm::dvec2& from, const glm::dvec2& to);

/// The distance between the two nearest parallel lines that have the polygon between them, one of them along an edge.
[[nodiscard]] double width(const FlatPolygon& polygon);

/// Whether no edge of either has the other outside. If they do not overlap, their overlap is no wider than the slack;
/// if they do, it still can be so, at a sharp corner.
[[nodiscard]] bool may_overlap(std::span<const FlatCorner> polygon, const FlatTriangle& triangle, double slack);

/// The two sides of a polygon along a line; a side that lies within the slack of the line is empty.
struct FlatSides {
  FlatPolygon inside = {};
  FlatPolygon outside = {};
};
[[nodiscard]] FlatSides sides_of(const FlatPolygon& polygon, const FlatLine& line, double slack);

/// What a triangle covers of a polygon, and the rest.
struct FlatCut {
  FlatPolygon inside = {};                ///< wider than the slack, or empty
  std::vector<FlatPolygon> outside = {};  ///< at most three, each wider than the slack
};
[[nodiscard]] FlatCut cut(const FlatPolygon& polygon, const FlatTriangle& triangle, double slack);

/// The polygon without corners that lie on the line between their neighbours.
[[nodiscard]] FlatPolygon without_flat_corners(FlatPolygon polygon, double slack);

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
