#pragma once

#include <stop_token>
#include <vector>

#include "deviation.hpp"
#include "point.hpp"

namespace detp::validate {

/// Runs every candidate of a point on all sets of the point. Returns the comparisons of formula and count, one for each
/// form of the formulas: of each term of Counts, and of m_i (rebuilds) and L_i (mean rays in the list) of each sphere i
/// with at least 30 rebuilds. The result depends only on the point and the seed. Returns nothing if a stop was
/// requested.
[[nodiscard]] std::vector<Deviation> measure_point(const SweepPoint& point, std::uint64_t seed,
                                                   const std::stop_token& stop);

}  // namespace detp::validate
