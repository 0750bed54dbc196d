#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Fits the unit costs of a technique to timed runs.
namespace detp::validate {

struct TimedRun {
  std::size_t workload = 0;  ///< runs of one workload are left out of a fit together
  Counts<double> counts = {};
  double seconds = 0;        ///< of the whole run: sorting, building and searching
  double build_seconds = 0;  ///< of sorting and building alone
};

struct CostFit {
  UnitCosts costs;
  std::size_t runs = 0;
  std::vector<std::string_view> fitted = {};   ///< symbols of the costs that are not 0
  std::vector<std::string_view> dropped = {};  ///< symbols of the costs that the runs could not tell apart from others
  double condition = 1;                        ///< of the matrix of the fitted terms, whose columns have length 1
  double median_error = 0;                     ///< of |computed / measured seconds - 1|, on the fitted runs
  std::vector<double> left_out_errors = {};    ///< |computed / measured seconds - 1| of each run, by fits without it
};

/// The largest condition number with which costs are used. With a larger one, some terms can hardly be told apart: those
/// with a large component in the singular vector of the smallest singular value. The one of these that contributes least
/// time is dropped.
inline constexpr double largest_condition = 60;

/// The unit costs, all >= 0, that minimise the sum of squared relative errors of the runs' seconds, plus that of their
/// seconds for sorting and building (non_negative_fit).
/// Only costs whose counts occur in the runs are fitted. The errors of left-out runs are those of five further fits of
/// the same terms: each leaves out the workloads whose number has one remainder modulo 5. Throws std::invalid_argument if there are fewer than 10 runs,
/// or if a run took no time.
[[nodiscard]] CostFit fit_costs(std::span<const TimedRun> runs, Technique technique);

}  // namespace detp::validate
