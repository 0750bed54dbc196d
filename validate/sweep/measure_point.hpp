#pragma once

#include <stop_token>
#include <vector>

#include "deviation.hpp"
#include "point.hpp"

namespace detp::validate {

/// Runs every candidate of a point on all its sets, and compares counts with the formulas: one row for each count, and
/// one for m_i and L_i of each sphere with at least 30 rebuilds.
///
/// A function of the seed and the point. Returns nothing if a stop was requested.
[[nodiscard]] std::vector<Deviation> measure_point(const SweepPoint& point, std::uint64_t seed,
                                                   const std::stop_token& stop);

}  // namespace detp::validate
