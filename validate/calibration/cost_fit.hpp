#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Fits the unit costs of a technique to timed runs, and its costs of threads to runs on one and on several threads.
namespace detp::validate {

struct TimedRun {
  std::size_t workload = 0;  ///< runs of one workload are left out of a fit together
  Counts<double> counts = {};
  double seconds = 0;        ///< of the whole run: sorting, building and searching
  double build_seconds = 0;  ///< of sorting and building alone
};

/// How well a technique's costs by one engine fit its runs.
struct FitQuality {
  Technique technique = Technique::brute_force;
  Engine engine = Engine::simd;
  std::size_t runs = 0;
  double median_error = 0;                   ///< of |computed / measured seconds - 1|, on the fitted runs
  std::vector<double> left_out_errors = {};  ///< |computed / measured seconds - 1| of each run, by fits without it

  /// The median of these errors.
  [[nodiscard]] double left_out_median_error() const;
};

struct CostFit : FitQuality {
  UnitCosts costs;
  std::vector<std::string_view> fitted = {};   ///< symbols of the costs that are not 0
  std::vector<std::string_view> dropped = {};  ///< symbols of the costs that the runs could not tell apart from others
  double condition = 1;                        ///< of the matrix of the fit, whose columns have length 1
};

/// The largest condition number with which costs are used. With a larger one, some terms can hardly be told apart: those
/// with a large component in the singular vector of the smallest singular value. The one of these that contributes least
/// time is dropped.
inline constexpr double largest_condition = 60;

/// How many runs that are off by 100 % weigh as much as a cost that is off by 100 % from its usual share.
inline constexpr double weight_of_usual = 0.3;

/// The unit costs x, all >= 0, for which this is least (non_negative_fit):
///
///     Σ (computed/measured - 1)², of the runs' seconds and of their seconds for sorting and building
///     + weight_of_usual Σ (x/(v x_usual) - 1)²
///
///   where  x_usual   `usual` costs, such as those of another machine; the second sum has only those above 0
///          v         median of measured seconds over those by the usual costs: how much slower this machine is
///
/// Runs decide the costs that they can tell apart. What they cannot, as in a disturbed calibration, keeps its usual ratio.
///
/// Only costs whose counts occur in the runs are fitted. The others are v x_usual, or 0 without usual costs. The errors of left-out runs are those of five further fits of
/// the same terms: each leaves out the workloads whose number has one remainder modulo 5. Throws std::invalid_argument
/// if there are fewer than 10 runs, or if a run took no time.
[[nodiscard]] CostFit fit_costs(std::span<const TimedRun> runs, Technique technique,
                                const std::optional<UnitCosts>& usual = {}, Engine engine = Engine::simd);

/// A search on several threads, beside the same search on one.
struct ThreadedRun {
  std::size_t workload = 0;    ///< runs of one workload are left out of a fit together
  Counts<double> counts = {};  ///< the same on any number of threads
  int threads = 2;             ///< at least 2
  double one_seconds = 0;      ///< on one thread: sorting, building and searching
  double one_preparing = 0;    ///< on one thread: sorting and building alone
  double seconds = 0;          ///< on `threads` threads
  double preparing = 0;        ///< on `threads` threads, sorting and building alone
};

struct ThreadFit : FitQuality {
  ThreadCosts costs;
};

/// The costs that minimise the sum of squared relative errors of the runs' seconds, plus that of their seconds for sorting
/// and building, plus weight_of_usual times the squared differences from the `usual` costs, if there are any: of the
/// shares, and of the start in units of the usual one (non_negative_fit). Times on one thread count as measured, so unit
/// costs have no influence. A share above 1 becomes 1; so does the share of a phase that no run divided among threads.
/// The errors of left-out runs are those of five further fits, as in fit_costs.
///
/// Throws std::invalid_argument if there are fewer than 5 runs, if a run has fewer than 2 threads, or if it took no time.
[[nodiscard]] ThreadFit fit_threads(std::span<const ThreadedRun> runs, Technique technique, Engine engine,
                                    const std::optional<ThreadCosts>& usual = {});

}  // namespace detp::validate
