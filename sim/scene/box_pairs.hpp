#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/base/function_ref.hpp"
#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

using BoxPair = std::array<std::uint32_t, 2>;  ///< the lower number first

/// The boxes, and what is wanted beyond that they touch. All are called from many threads.
struct BoxPairTests {
  FunctionRef<Box(std::uint32_t number)> box;
  FunctionRef<bool(std::uint32_t number, const Box& box)> near;     ///< false if nothing in the box can be a partner
  FunctionRef<bool(std::uint32_t one, std::uint32_t other)> match;  ///< whether the pair is wanted; `one` is lower
};

/// The pairs of boxes that touch, or nearly so, and match, in rising order; numbers are below `boxes`. A tree over the
/// boxes finds them: cost O(n log n) to build it, and for each box its partners and the way to them. Throws Stopped if a
/// stop was requested.
[[nodiscard]] std::vector<BoxPair> box_pairs(std::size_t boxes, const BoxPairTests& tests,
                                             const std::stop_token& stop = {});

}  // namespace detp::sim
