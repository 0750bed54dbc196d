#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cost_table.hpp"
#include "counts.hpp"
#include "technique.hpp"

namespace detp {

/// Where the counts of a prediction come from.
enum class Source {
  closed_form,
  sample,  ///< of rays, counted in parts of the index; of brute force: its tests, which are exact
  guess    ///< rough
};

/// What a search with a candidate is expected to do, and how long it takes.
struct Prediction {
  Candidate candidate = {};
  Counts<double> counts = {};
  CostBreakdown time = {};  ///< in the unit of the costs, seconds
  int threads = 1;          ///< for which the time is expected
  /// Standard error of the time: that of the counts (as if all counts were off in the same direction) and that of the unit
  /// costs. Of a closed form that is compared with a sample's counts, the time itself; of other closed forms 0, for not known.
  double error = 0;
  Counts<double> counts_error = {};  ///< standard errors of the counts; 0: exact, or not known (of a closed form)
  Source source = Source::closed_form;
  std::vector<std::string> extrapolated = {};  ///< reasons why a closed form may be far off; empty if there are none
  bool tuned = true;  ///< false: the parameters are good, but not the best; another technique is faster all the same
  /// it is compared with other candidates as if it took so many times as long; infinite: chosen only if all are
  double doubt = 1;
  /// The counts with the radius of the discs multiplied by `radius_ratio`, and with another number of rays. May be empty.
  std::function<Counts<double>(double radius_ratio, double rays)> counts_at = {};

  [[nodiscard]] double seconds() const { return time.total(); }
  /// The time with which it is compared.
  [[nodiscard]] double doubtful_seconds() const {
    return doubt < std::numeric_limits<double>::infinity() ? seconds() * doubt : doubt;
  }
};

}  // namespace detp
