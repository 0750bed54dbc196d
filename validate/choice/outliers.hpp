#pragma once

#include <string>
#include <vector>

#include "detp/sim/technique/technique.hpp"

/// Warnings of a few discs or rays that distort the workload, from which the models predict.
namespace detp::validate {

/// One sentence, with numbers, for each of these conditions; usually none:
///
///     discs far away        the box of all centres is over 4 times as long as that of the central 90 % on each axis.
///                           (1.0 to 2.4 times in 5 built-in scenes and 20 meshes; 13 000 in one made of two scales.)
///     large discs           the largest radius is over 10 times the median, or over 4 times if the root mean square
///                           is over 1.1 times the median
///     rays from far away    an origin is over 100 r₀ from the centre of S₀
///
/// Medians and central boxes are those of at most 4096 evenly spaced discs; the other values take one pass over discs
/// and rays. Throws sim::Stopped on a stop request.
[[nodiscard]] std::vector<std::string> outlier_warnings(const sim::Problem& problem, const std::stop_token& stop = {});

}  // namespace detp::validate
