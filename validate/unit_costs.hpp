#pragma once

#include <span>

#include "detp/model/vocabulary.hpp"

/// What each counted operation takes, in seconds.
namespace detp::validate {

/// Costs fitted to 258 runs of all techniques on one core of a cloud machine (validate/tables/unit_costs_table.cpp),
/// whose times they explain to a factor of 1.20 in the median and 2.24 at the 95th percentile. Another machine's may
/// differ by a factor of two; ratios between techniques hold better.
[[nodiscard]] UnitCosts built_in_unit_costs();

/// A run's counts and where its time went.
struct TimedRun {
  Counts<double> counts;
  double order = 0;   ///< seconds sorting samples
  double build = 0;   ///< seconds building an index
  double search = 0;  ///< seconds on all the rest
};

/// The unit costs that explain the runs best: least squares of relative errors, none negative (the most negative one is
/// set to zero and the rest fitted again until there is none).
/// Throws std::invalid_argument for fewer runs than costs.
[[nodiscard]] UnitCosts fit_unit_costs(std::span<const TimedRun> runs);

}  // namespace detp::validate
