#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "parameter.hpp"

namespace detp {

/// How a technique computes its decisions. Both engines find the same hits.
enum class Engine {
  plain,  ///< in double, one ray and one disc at a time: the simple version, for comparison
  /// lists of rays as vectors of floats; uncertain decisions are repeated in double. Same as plain if a technique has
  /// no simd engine
  simd
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<Engine>{"plain", "simd"};

/// Number of rays in a block. The simd engine searches all discs block by block: about four rays for each disc, at least 2¹⁵ and at
/// most 2²⁴. With fewer rays, lists become too short for vectors on the way to the leaves; lists of more do not stay in the caches.
///
/// Measured with lines through discs on the faces of a cube, the box tree, two cores (Zen 3, AVX2): 8·10⁶ lines and 10⁶ discs 9.1 s in blocks
/// of 2¹⁷ rays, 1.5 s in blocks of 2²²; 4·10⁶ lines and 10⁵ discs 0.57 s (2¹⁷), 0.38 s (2¹⁹), 0.35 s (2²⁰); 3·10⁴ discs 0.26 s (2¹⁷, 2¹⁸),
/// 0.36 s (2²⁰). 10⁹ lines and 10⁷ discs 806 s (2²²), 184 s (2²⁴).
[[nodiscard]] constexpr std::size_t rays_in_block(std::size_t discs) {
  constexpr std::size_t least = std::size_t{1} << 15;
  constexpr std::size_t most = std::size_t{1} << 24;
  return std::clamp(std::bit_ceil(std::min(4 * discs, most)), least, most);
}

/// Number of rays in the pieces that threads search in turn, one ray after another.
inline constexpr std::size_t rays_in_chunk = 64;

/// Number of discs that the simd engine's brute force tests against all rays of a block, as one piece of work. Their data
/// stay in the first-level cache.
inline constexpr std::size_t discs_in_chunk = 512;

/// The simd engine searches the children of a tree's node as separate tasks if the node's list holds at least this many
/// rays.
inline constexpr std::size_t rays_to_divide = std::size_t{1} << 10;

/// Number of blocks of rays_in_block rays for `rays` rays.
[[nodiscard]] inline double blocks_of(double rays, double discs) {
  constexpr double many = 1e9;  // more discs make no difference
  return std::ceil(rays / static_cast<double>(rays_in_block(static_cast<std::size_t>(std::min(discs, many)))));
}

/// The version of a formula.
enum class Form {
  published,  ///< as the paper printed it
  corrected   ///< as corrected by derivation and simulation
};
template <>
inline constexpr std::array<std::string_view, 2> choice_names<Form>{"published", "corrected"};

/// What a choice is based on.
enum class Rigor {
  estimate,    ///< closed forms alone
  structural,  ///< rays of the same kind, but not those of the run, through parts of the index
  pilot,       ///< some of the rays, through parts of the index
  measure      ///< runs of the candidates
};
template <>
inline constexpr std::array<std::string_view, 4> choice_names<Rigor>{"estimate", "structural", "pilot", "measure"};

}  // namespace detp
