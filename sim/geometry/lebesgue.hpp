#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "geometry.hpp"

/// The Morton curve (the paper: Lebesgue curve; also Z-order). Neighbours on the curve are mostly neighbours in space.
namespace detp::sim {

/// Place of a point on the curve: 48 bits, the three 16-bit numbers of the point's cell (curve_cell) interleaved. In
/// each triple of bits X comes first, then Y, then Z.
[[nodiscard]] std::uint64_t lebesgue_code(const glm::dvec3& point, const Box& box);

/// Returns the points' indices, ordered along the Morton curve through the points' bounding box. Points of the same
/// cell keep their order. Cost O(n): one pass for the codes, then a radix sort. At most 2³² - 1 points. Throws Stopped
/// if a stop was requested.
[[nodiscard]] std::vector<std::uint32_t> lebesgue_order(std::span<const glm::dvec3> points,
                                                        const std::stop_token& stop = {});

}  // namespace detp::sim
