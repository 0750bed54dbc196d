#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

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

}  // namespace detp::sim
