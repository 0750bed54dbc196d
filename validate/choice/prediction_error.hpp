#pragma once

#include <string_view>

#include "detp/model/rank/choose.hpp"

/// What a prediction missed.
namespace detp::validate {

/// Predicted over measured time, as a product: what the counts are off by, times what their unit costs are off by.
struct PredictionError {
  double seconds = 1;      ///< predicted time over measured
  double counts = 1;       ///< predicted time over that of what was counted, at the same unit costs
  double unit_costs = 1;   ///< time of what was counted, at the unit costs, over measured
  std::string_view worst;  ///< the count whose error costs most, as in Counts: "disc_tests"
  double worst_ratio = 1;  ///< of it, predicted over counted; infinite where none was counted
};

/// Measured seconds > 0.
[[nodiscard]] PredictionError prediction_error(const model::Ranked& predicted, const Counts<std::uint64_t>& counted,
                                               double seconds, const UnitCosts& costs);

}  // namespace detp::validate
