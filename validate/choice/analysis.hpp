#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/technique/technique.hpp"

/// Tests a choice: runs, counts and times the candidates.
namespace detp::validate {

/// A candidate: predicted if it was ranked; counted and measured if it was run to its end.
struct Analysed {
  Candidate candidate;
  int threads = 1;  ///< of its runs: those of the prediction, or else the most
  std::optional<Prediction> predicted = {};
  std::optional<Counts<std::uint64_t>> counted = {};
  std::optional<double> seconds = {};         ///< median of the timed runs (OwnTime)
  double spread = 0;                          ///< half the difference of the longest and shortest timed run, seconds
  std::optional<double> given_up_after = {};  ///< seconds after which the run was abandoned before it had ended
  std::string refused = {};  ///< the reason why it cannot be run here: its index does not fit in memory
};

struct Analysis {
  /// in the order of the ranking, then the techniques that were not ranked, then neighbours of the fastest
  std::vector<Analysed> candidates;
  int tried = 0;                    ///< number of candidates that were run to their end or abandoned
  std::optional<std::size_t> best;  ///< index of the candidate with the shortest measured time
  /// measured time of the predicted choice (the first candidate) divided by the shortest measured time, minus 1
  std::optional<double> regret;
  /// of the regret: half the ranges of both candidates' timed runs, together, over the shortest time
  double regret_error = 0;
  bool stopped = false;  ///< true if a stop was requested: some candidates may not have been run and timed

  /// The candidate with the shortest measured time; null without one.
  [[nodiscard]] const Analysed* fastest() const { return best ? &candidates[*best] : nullptr; }
};

struct AnalysisOptions {
  int repeats = 5;                       ///< rounds of timed runs, at least (ExhaustiveOptions)
  std::vector<Technique> disabled = {};  ///< techniques that are not added to the ranked ones
  Engine engine = Engine::simd;          ///< of all runs
  double check_seconds = 0;              ///< of checking rays and discs: a part of each run
  int threads = 1;                       ///< of the runs of candidates without a prediction, if they are divided
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

/// Measures the ranked candidates, the exact techniques that were not ranked, and neighbours of the two fastest (measure_all). What is predicted to be
/// slow is started too, and abandoned after five times the shortest time so far, but at least 20 ms; the predicted choice never.
/// Ranked candidates are judged by times by which the fastest was not selected. `best` is the one with the least time of all, so that a regret
/// is too high rather than too low, by about regret_error.
[[nodiscard]] Analysis analyse(const sim::Problem& problem, const std::vector<Prediction>& ranking,
                               const AnalysisOptions& options = {});

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
