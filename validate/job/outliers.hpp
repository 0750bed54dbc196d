#pragma once

#include <string>
#include <vector>

#include "detp/sim/technique/technique.hpp"

/// Warnings about a few discs or rays that distort the workload, from which the models predict.
namespace detp::validate {

/// Returns one sentence, with numbers, for each of these conditions that holds; usually none:
///
///     discs far away        as sim/effects/far_discs.hpp says
///     large discs           the largest radius is over 10 times the median radius, or over 4 times if the root mean
///                           square radius is over 1.1 times the median
///     rays from far away    an origin is over 100 r₀ from the centre of S₀
///
/// The median is that of at most 4096 discs, evenly spaced in the array; the other values are computed from all discs and
/// rays. Throws sim::Stopped if a stop was requested.
[[nodiscard]] std::vector<std::string> outlier_warnings(const sim::Problem& problem, const std::stop_token& stop = {});

}  // namespace detp::validate
