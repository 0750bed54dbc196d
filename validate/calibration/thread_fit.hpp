#pragma once

#include <optional>
#include <span>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// Fits the costs of threads of a technique to runs on one and on several threads.
namespace detp::validate {

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

struct ThreadFit {
  ThreadCosts costs;
  std::size_t runs = 0;
  double median_error = 0;                   ///< of |computed / measured seconds - 1|, on the fitted runs
  std::vector<double> left_out_errors = {};  ///< |computed / measured seconds - 1| of each run, by fits without it
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
