#pragma once

#include <array>
#include <stop_token>
#include <string_view>

#include "mesh.hpp"

namespace detp::sim {

/// The direction of a scene that points up: a coordinate axis or its opposite.
struct Up {
  int axis = 1;  ///< 0, 1, 2: x, y, z
  int sign = 1;  ///< 1 or -1

  bool operator==(const Up&) const = default;

  /// The rotation that turns this direction to +Y. It permutes coordinates and changes signs, so it is exact.
  [[nodiscard]] glm::dvec3 to_y(const glm::dvec3& vector) const;
  /// The inverse rotation.
  [[nodiscard]] glm::dvec3 from_y(const glm::dvec3& vector) const;
};

inline constexpr std::array<std::pair<std::string_view, Up>, 6> named_ups{
    {{"x", {0, 1}}, {"y", {1, 1}}, {"z", {2, 1}}, {"-x", {0, -1}}, {"-y", {1, -1}}, {"-z", {2, -1}}}};

/// "x", "-z", …
[[nodiscard]] std::string_view name(const Up& up);

/// Which of the six directions of a mesh is up, as far as its shape tells. Files don't say.
///
/// Ground, floors and roofs are horizontal. So the axis is that with the largest coverage: the share of columns along it
/// (32 × 32 over the box) in which some surface is nearly horizontal. Most files mean Y: another axis must cover more by
/// 0.15 (X more than Z by 0.05). The axis points up, unless both ends tell otherwise by 0.2: the share of columns with a
/// horizontal surface in the lowest 15 % of the box, less that in the highest 15 %, plus the share of horizontal
/// surface that faces up, less that which faces down.
///
/// A coverage below 0.75 is no ground: a single object does not tell which way is up. Then the answer is +Y. The box is that of the used vertices. Cost
/// O(triangles). Throws Stopped if a stop was requested.
[[nodiscard]] Up up_of(const Mesh& mesh, const Box& box, const std::stop_token& stop = {});

}  // namespace detp::sim
