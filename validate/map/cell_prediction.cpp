#include "cell_prediction.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/choice/allowed_ranking.hpp"

namespace detp::validate {
namespace {

CellPrediction comparable(CellPrediction prediction) {
  if (prediction.ranking.empty()) throw std::invalid_argument("no technique is left that can be predicted");
  for (const model::Ranked& one : prediction.ranking)
    if (const double seconds = one.time.total(); !(seconds > 0 && std::isfinite(seconds)))
      throw std::invalid_argument(
          fmt::format("with these unit costs {} takes {} s, so that nothing can be compared; give every operation its "
                      "cost in seconds",
                      name(one.candidate.technique), seconds));
  return prediction;
}

}  // namespace

CellPrediction predict_by_estimate(const Workload& workload, const CostTable& costs, const PilotOptions& options) {
  std::vector<model::Ranked> ranking = allowed_ranking(
      workload, costs, options.disabled, {.threads = sim::useful_threads(options.threads), .stop = options.stop});
  if (options.stop.stop_requested()) throw sim::Stopped("stopped while techniques were ranked");
  return comparable({.rigor = Rigor::estimate, .ranking = std::move(ranking)});
}

CellPrediction predict_by_pilot(const sim::Problem& problem, double rays, const CostTable& costs,
                                const PilotOptions& options) {
  const PilotChoice pilot =
      choose_by_pilot(problem, pilot_sample(problem.rays(), problem.discs().size()), rays, costs, options);
  CellPrediction prediction{
      .rigor = Rigor::pilot, .ranking = {}, .ruled_out = pilot.ruled_out, .error = pilot.choice().error};
  for (const Piloted& one : pilot.candidates)
    prediction.ranking.push_back({one.candidate, one.counts, one.time, one.extrapolated, one.threads});
  return comparable(std::move(prediction));
}

}  // namespace detp::validate
