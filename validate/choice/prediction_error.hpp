#pragma once

#include <string_view>

#include "detp/model/rank/choose.hpp"

/// The error of a prediction.
namespace detp::validate {

/// Predicted time / measured time, as the product of two ratios: the error of the counts and the error of the unit
/// costs.
struct PredictionError {
  double seconds = 1;      ///< predicted time / measured time
  double counts = 1;       ///< predicted time / time of the observed counts at the same unit costs
  double unit_costs = 1;   ///< time of the observed counts at the unit costs / measured time
  std::string_view worst;  ///< the count whose error changes the time most, as in Counts: "disc_tests"
  double worst_ratio = 1;  ///< predicted / observed value of the worst count; infinite if its observed value is 0
};

/// Requires measured seconds > 0.
[[nodiscard]] PredictionError prediction_error(const Prediction& predicted, const Counts<std::uint64_t>& counted,
                                               double seconds, const CostTable& costs);

}  // namespace detp::validate
