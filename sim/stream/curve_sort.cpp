#include "curve_sort.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace detp::sim::stream {
namespace {

/// Moves bit i of a 10-bit number to bit 3i.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x0300'00ff;
  bits = (bits | bits << 8) & 0x0300'f00f;
  bits = (bits | bits << 4) & 0x030c'30c3;
  bits = (bits | bits << 2) & 0x0924'9249;
  return bits;
}

constexpr int digit_bits = 10;
constexpr int digits = 3;
using Histogram = std::array<std::uint32_t, 1 << digit_bits>;

std::uint32_t digit(CurvePlace place, int number) {
  return place_code(place) >> (digit_bits * number) & ((1U << digit_bits) - 1);
}

}  // namespace

std::vector<CurvePlace> sort_along_curve(std::span<const Disc> discs, const Frame&) {
  Box box;
  for (const Disc& disc : discs) box.include(disc.centre);
  const glm::dvec3 size = box.size();
  const double side = std::max({size.x, size.y, size.z});
  const double cells = side > 0 ? 1024 / side : 0;
  const auto cell = [cells](double above) { return std::min(static_cast<std::uint32_t>(above * cells), 1023U); };
  std::array<Histogram, digits> starts{};
  std::vector<CurvePlace> places(discs.size());
  for (std::uint32_t i = 0; i < discs.size(); ++i) {
    const glm::dvec3 above = discs[i].centre - box.low;
    const std::uint32_t code = spread(cell(above.x)) << 2 | spread(cell(above.y)) << 1 | spread(cell(above.z));
    places[i] = static_cast<CurvePlace>(code) << 32 | i;
    for (int d = 0; d < digits; ++d) ++starts[static_cast<std::size_t>(d)][digit(places[i], d)];
  }
  std::vector<CurvePlace> other(discs.size());
  for (int d = 0; d < digits; ++d) {
    Histogram& start = starts[static_cast<std::size_t>(d)];
    if (start[digit(places.front(), d)] == places.size()) continue;
    std::uint32_t next = 0;
    for (std::uint32_t& count : start) next += std::exchange(count, next);
    for (const CurvePlace place : places) other[start[digit(place, d)]++] = place;
    places.swap(other);
  }
  return places;
}

}  // namespace detp::sim::stream
