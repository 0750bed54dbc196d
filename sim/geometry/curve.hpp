#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/base/radix_sort.hpp"
#include "geometry.hpp"

/// What the space-filling curves share: a grid of 65536 cells per side, and sorting points by place on the curve.
namespace detp::sim {

/// A cell's number along each axis, 16 bits each.
using CurveCell = std::array<std::uint32_t, 3>;

/// The cell of a point.
///
/// Coordinates are measured from the box's low corner in units of 1/65536 of the longest side, so cells are cubes. (The
/// paper stretches each side to the full 16 bits. In a flat scene the paper's cells are flat.) A point outside the box
/// belongs to the cell nearest to the point.
[[nodiscard]] inline CurveCell curve_cell(const glm::dvec3& point, const Box& box) {
  const glm::dvec3 size = box.size();
  const double side = std::max({size.x, size.y, size.z});
  CurveCell cell{};
  if (!(side > 0)) return cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = std::floor((point[axis] - box.low[axis]) / side * 65536.0);
    cell[axis] = static_cast<std::uint32_t>(std::clamp(place, 0.0, 65535.0));
  }
  return cell;
}

/// Peak bytes of sorting `points` points: copies of their positions, and the radix sort's two arrays of entries.
[[nodiscard]] inline double sorting_bytes(std::size_t points) {
  return (sizeof(glm::dvec3) + 2 * sizeof(KeyedIndex)) * static_cast<double>(points);
}

/// Returns the points' indices in order of rising code(point, the points' bounding box). Codes have 48 bits. Points of
/// the same code keep their order. At most 2³² - 1 points. Throws Stopped if a stop was requested.
template <class Code>
[[nodiscard]] std::vector<std::uint32_t> order_along(std::span<const glm::dvec3> points, const Code& code,
                                                     const std::stop_token& stop) {
  StopCheck check(stop, "sorting along a curve");
  Box box;
  for (const glm::dvec3& point : points) box.include(point);
  std::vector<KeyedIndex> entries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    entries[i] = {code(points[i], box), static_cast<std::uint32_t>(i)};
    check.after(1);
  }
  radix_sort(entries, 48, stop);
  std::vector<std::uint32_t> order(points.size());
  std::transform(entries.begin(), entries.end(), order.begin(), [](const KeyedIndex& entry) { return entry.index; });
  return order;
}

// The Morton curve (the paper: Lebesgue curve; also Z-order). Neighbours on the curve are mostly neighbours in space.

/// Place of a point on the curve: 48 bits, the three 16-bit numbers of the point's cell (curve_cell) interleaved. In
/// each triple of bits X comes first, then Y, then Z.
[[nodiscard]] std::uint64_t lebesgue_code(const glm::dvec3& point, const Box& box);

/// Returns the points' indices, ordered along the Morton curve through the points' bounding box. Points of the same
/// cell keep their order. Cost O(n): one pass for the codes, then a radix sort. At most 2³² - 1 points. Throws Stopped
/// if a stop was requested.
[[nodiscard]] std::vector<std::uint32_t> lebesgue_order(std::span<const glm::dvec3> points,
                                                        const std::stop_token& stop = {});

}  // namespace detp::sim
