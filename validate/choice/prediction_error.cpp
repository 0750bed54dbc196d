#include "prediction_error.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace detp::validate {

PredictionError prediction_error(const Prediction& predicted, const Counts<std::uint64_t>& counted, double seconds,
                                 const CostTable& costs) {
  const Counts<double> found = as_expected(counted);
  const Technique technique = predicted.candidate.technique;
  const double counted_seconds = price(found, costs, technique, predicted.threads).again();
  PredictionError error{.seconds = predicted.time.again() / seconds,
                        .counts = predicted.time.again() / counted_seconds,
                        .unit_costs = counted_seconds / seconds,
                        .worst = {}};
  double most = -1;
  for (const auto& [name, term] : count_terms<double>) {
    const double expected = predicted.counts.*term;
    Counts<double> difference;
    difference.*term = std::abs(expected - found.*term);
    const double weight = price(difference, costs, technique).total();
    if (!(weight > most)) continue;
    most = weight;
    error.worst = name;
    error.worst_ratio = expected == found.*term ? 1
                        : found.*term > 0       ? expected / found.*term
                                                : std::numeric_limits<double>::infinity();
  }
  return error;
}

}  // namespace detp::validate
