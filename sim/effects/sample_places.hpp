#pragma once

#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/base/radix_sort.hpp"
#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Levels of cells of Lebesgue's curve: on each level, a cell is halved along all three axes.
inline constexpr int levels_of_cells = 16;

/// The discs with the numbers in `sample`, with their places on Lebesgue's curve through their box, in the order of the
/// curve: that of cells on every level. The index is the disc's number. Throws Stopped if a stop was requested.
[[nodiscard]] std::vector<KeyedIndex> sample_places(std::span<const Disc> discs, std::span<const std::size_t> sample,
                                                    const std::stop_token& stop = {});

/// The same of at most 8192 discs, stratified.
[[nodiscard]] std::vector<KeyedIndex> sampled_places(std::span<const Disc> discs, const std::stop_token& stop = {});

}  // namespace detp::sim
