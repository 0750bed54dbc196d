#pragma once

#include <span>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"

/// Bias where there is no scene to judge by.
namespace detp::validate {

/// bias² of estimates with discs of radius d, relative to their mean square, from R ≥ 3 runs of independent photons at the same discs with
/// radius d (`wide`) and d/2 (`narrow`):
///
///     bias(d) = c (E(d) - E(d/2))   c = 2 if the bias grows as d (edges), 4/3 if it grows as d² (smooth light)
///
/// Its mean is that of both c; its standard error has their difference, and the jackknife over the runs. Blur that both radii share is
/// not seen. `weights` of the discs, with sum 1. Throws std::invalid_argument for fewer runs, and if no light meets the discs.
[[nodiscard]] Estimate bias_by_two_radii(std::span<const std::vector<double>> wide,
                                         std::span<const std::vector<double>> narrow, std::span<const double> weights);

}  // namespace detp::validate
