#include "lebesgue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace detp::sim {
namespace {

struct Entry {
  std::uint64_t code;
  std::uint32_t index;
};

/// Moves bit i of a 16-bit number to bit 3i.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 16) & 0x0000'ff00'00ff;
  bits = (bits | bits << 8) & 0x00f0'0f00'f00f;
  bits = (bits | bits << 4) & 0x0c30'c30c'30c3;
  bits = (bits | bits << 2) & 0x2492'4924'9249;
  return bits;
}

/// Stable sort by the digit of 8 bits at `shift`; false where all digits are equal and nothing was done.
bool sort_by_digit(const std::vector<Entry>& from, std::vector<Entry>& to, int shift) {
  std::array<std::size_t, 256> place{};
  const auto digit = [shift](const Entry& entry) { return (entry.code >> shift) & 0xff; };
  for (const Entry& entry : from) ++place[digit(entry)];
  if (place[digit(from.front())] == from.size()) return false;
  std::size_t next = 0;
  for (std::size_t& start : place) next += std::exchange(start, next);
  for (const Entry& entry : from) to[place[digit(entry)]++] = entry;
  return true;
}

}  // namespace

std::uint64_t lebesgue_code(const glm::dvec3& point, const Box& box) {
  const glm::dvec3 size = box.size();
  const double side = std::max({size.x, size.y, size.z});
  const auto coordinate = [&](int axis) -> std::uint64_t {
    if (!(side > 0)) return 0;
    const double cell = std::floor((point[axis] - box.low[axis]) / side * 65536.0);
    return static_cast<std::uint64_t>(std::clamp(cell, 0.0, 65535.0));
  };
  return spread(coordinate(0)) << 2 | spread(coordinate(1)) << 1 | spread(coordinate(2));
}

std::vector<std::uint32_t> lebesgue_order(std::span<const glm::dvec3> points) {
  std::vector<std::uint32_t> order(points.size());
  if (points.empty()) return order;
  Box box;
  for (const glm::dvec3& point : points) box.include(point);
  std::vector<Entry> entries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    entries[i] = {lebesgue_code(points[i], box), static_cast<std::uint32_t>(i)};
  std::vector<Entry> other(points.size());
  for (int shift = 0; shift < 48; shift += 8)
    if (sort_by_digit(entries, other, shift)) entries.swap(other);
  std::transform(entries.begin(), entries.end(), order.begin(), [](const Entry& entry) { return entry.index; });
  return order;
}

}  // namespace detp::sim
