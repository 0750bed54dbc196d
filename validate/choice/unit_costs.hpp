#pragma once

#include <span>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The time of each counted operation, in seconds.
namespace detp::validate {

/// Costs fitted to 274 runs of all techniques with a closed form, on one core of a cloud machine with AVX-512: lines
/// among uniform samples (validate/tools/unit_costs_table.cpp). Measured in processor time, because the machine was
/// shared. They explain the times to a factor of 1.23 in the median and 2.73 at the 95th percentile. By technique,
/// predicted over measured, from the 10th to the 90th percentile: brute force 0.92 … 1.00, sphere cache 0.65 … 1.22,
/// cell spheres 0.23 … 0.93, box tree 1.06 … 1.29, octree 0.73 … 1.63, grid 0.62 … 1.43. Going on to the next disc,
/// about 100 ns, has no cost of its own: if lists are short, cell spheres take up to six times the predicted time. The
/// costs of lists are those of the float kernels; a sphere tree with spheres, which works in doubles, is not among the
/// runs. Costs on another machine may differ by a factor of two, or by the ratio of the vector widths; ratios between
/// techniques are more reliable.
///
/// The fit had one cost, 2.2e-8, for sorting a disc together with building a box tree over it. `sort` and `leaf` are
/// half of it each: their sum, which a box tree pays, is measured; its division into two is not.
[[nodiscard]] UnitCosts built_in_unit_costs();

/// A run's counts and times.
struct TimedRun {
  Technique technique = Technique::brute_force;
  Counts<double> counts = {};
  double order = 0;   ///< seconds for sorting samples
  double build = 0;   ///< seconds for building an index
  double search = 0;  ///< seconds for all the rest
};

/// The unit costs that explain the runs best: least squares of relative errors, none negative (non_negative_fit).
/// Throws std::invalid_argument if there are fewer runs than costs, and for a run whose search took no time.
[[nodiscard]] UnitCosts fit_unit_costs(std::span<const TimedRun> runs);

}  // namespace detp::validate
