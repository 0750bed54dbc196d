#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "technique_model.hpp"

namespace detp::model {

/// Keeps the fastest of the parameters passed to `consider`, without those that need too many references.
template <class P>
class Fastest {
 public:
  Fastest(const UnitCosts& costs, Technique technique, const SearchLimits& limits)
      : costs_(costs), technique_(technique), limits_(limits) {}

  /// Returns the time for these counts; infinite if there are too many references.
  double consider(const P& parameters, const Counts<double>& counts) {
    if (counts.references > limits_.most_references) return std::numeric_limits<double>::infinity();
    const double time = price(counts, costs_, technique_).total();
    if (!found_ || time < least_) {
      best_ = parameters;
      least_ = time;
      found_ = true;
    }
    return time;
  }

  /// Whether counts at least as large as these, except that disc_tests may fall to the number of hits, take longer than
  /// the fastest.
  [[nodiscard]] bool excludes(Counts<double> counts) const {
    if (counts.references > limits_.most_references) return true;
    counts.disc_tests = std::min(counts.disc_tests, counts.hits);
    return price(counts, costs_, technique_).total() > least_;
  }

  [[nodiscard]] std::optional<P> best() const { return found_ ? std::optional<P>(best_) : std::nullopt; }

  /// The time of the fastest; infinite if there is none.
  [[nodiscard]] double least() const { return least_; }

 private:
  const UnitCosts& costs_;
  Technique technique_;
  const SearchLimits& limits_;
  bool found_ = false;
  P best_{};
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace detp::model
