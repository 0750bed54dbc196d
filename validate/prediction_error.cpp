#include "prediction_error.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace detp::validate {

PredictionError prediction_error(const model::Ranked& predicted, const Counts<std::uint64_t>& counted, double seconds,
                                 const UnitCosts& costs) {
  const Counts<double> found = as_expected(counted);
  const Technique technique = predicted.candidate.technique;
  const double counted_seconds = price(found, costs, technique).total();
  PredictionError error{.seconds = predicted.time.total() / seconds,
                        .counts = predicted.time.total() / counted_seconds,
                        .unit_costs = counted_seconds / seconds,
                        .worst = {}};
  double most = -1;
  for_each_term(predicted.counts, [&](std::string_view term, double value) {
    Counts<double> difference;
    double of_found = 0;
    for_each_term(found, [&](std::string_view name, double count) { of_found = name == term ? count : of_found; });
    for_each_term(difference, [&](std::string_view name, double& count) {
      if (name == term) count = std::abs(value - of_found);
    });
    const double weight = price(difference, costs, technique).total();
    if (!(weight > most)) return;
    most = weight;
    error.worst = term;
    error.worst_ratio = value == of_found ? 1
                        : of_found > 0    ? value / of_found
                                          : std::numeric_limits<double>::infinity();
  });
  return error;
}

}  // namespace detp::validate
