#pragma once

#include <span>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The time of each counted operation, in seconds.
namespace detp::validate {

/// Costs fitted to 274 runs of all techniques with a closed form except sphere-tree: isotropic lines, uniform samples,
/// one core of a cloud machine with AVX-512 (validate/tools/unit_costs_table.cpp). The times are processor time,
/// because the machine was shared.
///
/// Accuracy   observed counts multiplied by the costs, compared with the measured times of the same runs: wrong by a
///            factor of 1.23 in the median and 2.73 at the 95th percentile. Computed / measured time, 10th to 90th
///            percentile: brute force 0.92 … 1.00, sphere cache 0.65 … 1.22, cell spheres 0.23 … 0.93, box tree 1.06 …
///            1.29, octree 0.73 … 1.63, grid 0.62 … 1.43.
/// Limits     `visit` is 0, although advancing to the next disc takes about 100 ns. So cell spheres take up to six
///            times the computed time if lists are short. The costs of lists are those of the float kernels, but
///            sphere-tree works in doubles. Times on another machine may differ by a factor of two, or by the ratio of
///            the vector widths; ratios between techniques are more reliable.
///
/// Sorting one disc and inserting it into a box tree together take 2.2e-8 s (measured). `sort` and `leaf` have half of
/// this time each; the two were not measured separately.
[[nodiscard]] UnitCosts built_in_unit_costs();

struct TimedRun {
  Technique technique = Technique::brute_force;
  Counts<double> counts = {};
  double order = 0;   ///< seconds for sorting samples
  double build = 0;   ///< seconds for building an index
  double search = 0;  ///< seconds for all the rest
};

/// The unit costs, all >= 0, with the least sum of squared relative errors of the runs' search times
/// (non_negative_fit). For `placement`, `leaf` and `sort`, the cost is instead the sum of the seconds divided by the
/// sum of the counts. Throws std::invalid_argument if there are fewer runs than fitted costs (7), and for a run whose
/// search took no time.
[[nodiscard]] UnitCosts fit_unit_costs(std::span<const TimedRun> runs);

}  // namespace detp::validate
