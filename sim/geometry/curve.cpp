#include "curve.hpp"

namespace detp::sim {
namespace {

/// Moves bit i of a 16-bit number to bit 3i.
std::uint64_t spread_16_bits(std::uint64_t bits) {
  bits = (bits | bits << 16) & 0x0000'ff00'00ff;
  bits = (bits | bits << 8) & 0x00f0'0f00'f00f;
  bits = (bits | bits << 4) & 0x0c30'c30c'30c3;
  bits = (bits | bits << 2) & 0x2492'4924'9249;
  return bits;
}

}  // namespace

std::uint64_t lebesgue_code(const glm::dvec3& point, const Box& box) {
  const CurveCell cell = curve_cell(point, box);
  return spread_16_bits(cell[0]) << 2 | spread_16_bits(cell[1]) << 1 | spread_16_bits(cell[2]);
}

std::vector<std::uint32_t> lebesgue_order(std::span<const glm::dvec3> points, const std::stop_token& stop) {
  return order_along(points, lebesgue_code, stop);
}

}  // namespace detp::sim
