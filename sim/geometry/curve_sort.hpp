#pragma once

#include <cstdint>
#include <span>
#include <stop_token>

#include "detp/sim/base/page_pool.hpp"
#include "geometry.hpp"

/// Sorts discs along the Morton curve (the paper: Lebesgue curve), coarsely and fast.
namespace detp::sim::stream {

/// One word for one disc. The upper 32 bits are its place on the curve (at most 10 bits a coordinate), the lower 32
/// bits its number.
using CurvePlace = std::uint64_t;
using CurvePlaces = UnsetVector<CurvePlace>;

[[nodiscard]] constexpr std::uint32_t place_code(CurvePlace place) { return static_cast<std::uint32_t>(place >> 32); }
[[nodiscard]] constexpr std::uint32_t place_index(CurvePlace place) { return static_cast<std::uint32_t>(place); }

/// Returns one CurvePlace for each disc, in the curve's order. `centres` is the box around the discs' centres. Cells are cubes. Their
/// side is 1/1024 of its longest side, or 1/64 of it for fewer than 8192 discs. Discs in one cell keep their order. Up to `unsorted`
/// discs that are together in a larger cell of the curve may keep their order, too: a tree with leaves of that size is the same. Throws
/// Stopped if a stop was requested.
[[nodiscard]] CurvePlaces sort_along_curve(std::span<const Disc> discs, const Box& centres, std::size_t unsorted = 1,
                                           const std::stop_token& stop = {});

}  // namespace detp::sim::stream
