#pragma once

#include <array>
#include <optional>
#include <stop_token>

#include "cost_fit.hpp"
#include "detp/sim/base/phase.hpp"

/// Measures the unit costs of this machine.
namespace detp::validate {

struct CalibrationOptions {
  double seconds = 15;  ///< no workload starts after this time, but some small ones are always measured
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct Calibration {
  CostTable costs;  ///< the fitted ones; the built-in ones of techniques without a fit
  /// by technique, in the order of Technique; empty for techniques that are not exact and for those with too few runs
  std::array<std::optional<CostFit>, all_techniques.size()> fits = {};
  double left_out_median_error = 0;  ///< of all techniques' runs, by fits to other workloads
  std::size_t workloads = 0;         ///< measured
  double seconds = 0;                ///< that the calibration took
  /// processor time over wall time of all runs; below 0.9, other programs were busy, and costs are in processor time
  double processor_share = 1;
  bool stopped = false;  ///< a stop request came: the costs are fitted to the workloads measured until then
};

/// A calibration whose median error on left-out workloads exceeds this is doubtful.
inline constexpr double doubtful_error = 0.15;

/// Times all exact techniques, with several parameters each, on uniform samples in a cube and on its faces and on
/// isotropic lines: 10² … 10⁵ discs (10⁶ once), 10² … 10⁵ rays, from few to very many hits. One thread. Runs of more than
/// 0.06 s are left out. A run is timed up to seven times, until 0.01 s have passed; the shortest time counts. Fits the
/// unit costs of each technique to its runs, in seconds. A technique with fewer than 10 runs keeps the built-in costs.
[[nodiscard]] Calibration calibrate(const CalibrationOptions& options = {});

}  // namespace detp::validate
