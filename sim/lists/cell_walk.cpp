#include "cell_walk.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "detp/sim/geometry/curve.hpp"

namespace detp::sim {
namespace {

constexpr int code_digits = 16;

/// Octal digit number `level` (1 … 16) of the code: selects one of the eight octants of the cell at level - 1.
std::uint64_t octant(std::uint64_t code, int level) { return code >> 3 * (code_digits - level) & 7; }

/// The last level at which both codes have the same cell.
int last_common_level(std::uint64_t a, std::uint64_t b) {
  const int leading_zeros_of_48 = std::countl_zero(a ^ b) - 16;
  return leading_zeros_of_48 / 3;
}

}  // namespace

CellWalk::CellWalk(std::span<const Disc> discs, int depth) : spheres_(static_cast<std::size_t>(depth) + 1) {
  double largest = 0;
  for (const Disc& disc : discs) {
    box_.include(disc.centre);
    largest = std::max(largest, disc.radius);
  }
  const glm::dvec3 size = box_.size();
  side_ = std::max({size.x, size.y, size.z});
  for (int level = 0; level <= depth; ++level)
    spheres_[static_cast<std::size_t>(level)].radius = std::ldexp(side_, -level) * std::sqrt(0.75) + largest;
  spheres_[0].centre = box_.low + 0.5 * side_;
}

int CellWalk::enter(const Disc& disc) {
  const std::uint64_t code = lebesgue_code(disc.centre, box_);
  const int first = entered_ ? last_common_level(code, code_) + 1 : 0;
  const int depth = static_cast<int>(spheres_.size()) - 1;
  glm::dvec3 cell{0};  // the cell's number along each axis
  for (int level = 1; level <= depth; ++level) {
    const std::uint64_t digit = octant(code, level);
    cell = 2.0 * cell + glm::dvec3{digit >> 2 & 1, digit >> 1 & 1, digit & 1};
    if (level >= first)
      spheres_[static_cast<std::size_t>(level)].centre = box_.low + std::ldexp(side_, -level) * (cell + 0.5);
  }
  code_ = code;
  entered_ = true;
  return std::clamp(first, 1, depth + 1);
}

}  // namespace detp::sim
