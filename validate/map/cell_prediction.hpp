#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/search/problem.hpp"
#include "detp/validate/choice/pilot.hpp"

/// The prediction for one cell of a map.
namespace detp::validate {

struct CellPrediction {
  Rigor rigor = Rigor::estimate;
  std::vector<model::Ranked> ranking;    ///< fastest first; the first is the choice
  std::vector<RuledOut> ruled_out = {};  ///< by a pilot: techniques that are not in the ranking
  double error = 0;                      ///< standard error of the choice's time because of sampling, seconds

  [[nodiscard]] const model::Ranked& choice() const { return ranking.front(); }
};

/// By closed forms. Throws as model::rank, sim::Stopped on a stop request, and std::invalid_argument if no technique is
/// left or if the predicted times are 0 or not finite.
[[nodiscard]] CellPrediction predict_by_estimate(const Workload& workload, const CostTable& costs,
                                                 const PilotOptions& options);

/// By a pilot of the problem's rays, which stand for `rays` rays. Throws as choose_by_pilot, and as above.
[[nodiscard]] CellPrediction predict_by_pilot(const sim::Problem& problem, double rays, const CostTable& costs,
                                              const PilotOptions& options);

}  // namespace detp::validate
