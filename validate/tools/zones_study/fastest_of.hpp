#pragma once

#include <optional>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// The fastest parameters of one technique, found by running it.
namespace detp::zones {

/// The shortest time of several runs, on one thread.
struct FirstRuns {
  Candidate candidate;
  double seconds = 0;      ///< if it was abandoned, a lower bound
  bool abandoned = false;  ///< a run took longer than the limit
};

/// Seconds of one run that does not count; nullopt if it took longer than `limit`.
[[nodiscard]] std::optional<double> time_of(const sim::Problem& problem, const Candidate& candidate, Engine engine,
                                            double limit);

struct TimeLimits {
  double first;  ///< seconds after which the first run is abandoned
  double tuned;  ///< a candidate whose first run takes longer is not compared with its neighbours
};

/// Runs the candidate and its neighbours, then those of the fastest, until none is faster. Only the first may be abandoned.
/// nullopt if the index of the first does not fit in memory.
[[nodiscard]] std::optional<FirstRuns> fastest_of(const sim::Problem& problem, const Candidate& first, Engine engine,
                                                  const TimeLimits& limits);

}  // namespace detp::zones
