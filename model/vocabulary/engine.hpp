#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "parameter.hpp"

namespace detp {

/// How a technique decides. The hits are the same.
enum class Engine {
  plain,  ///< in double, one ray and one disc at a time: the simple version, to compare with
  simd    ///< lists of rays in vectors of floats, what floats cannot decide again in double; plain where there is none
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<Engine>{"plain", "simd"};

/// Rays whose lists the simd engine holds at a time: each such block visits the discs again. Their lists (20 or 28
/// bytes a ray) should stay in the second-level cache while they are culled: 2¹⁵ for few discs, where most culls are
/// near the root, up to 2¹⁷ for many. (2¹³ took 1.1 to 2 times as long, 2¹⁷ for some thousand discs 1.3 times.)
[[nodiscard]] constexpr std::size_t rays_in_block(std::size_t discs) {
  constexpr std::size_t least = std::size_t{1} << 15;
  constexpr std::size_t most = std::size_t{1} << 17;
  return std::clamp(std::bit_ceil(std::min(4 * discs, most)), least, most);
}

/// Such blocks of so many rays.
[[nodiscard]] inline double blocks_of(double rays, double discs) {
  constexpr double many = 1e9;  // as far as the number of discs matters
  return std::ceil(rays / static_cast<double>(rays_in_block(static_cast<std::size_t>(std::min(discs, many)))));
}

}  // namespace detp
