#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/sim/technique/technique.hpp"

/// Tests a choice: runs, counts and times the candidates.
namespace detp::validate {

/// A candidate: predicted if it has a closed form; counted and measured if it was run to its end.
struct Analysed {
  Candidate candidate;
  std::optional<model::Ranked> predicted = {};
  std::optional<Counts<std::uint64_t>> counted = {};
  std::optional<double> seconds = {};         ///< median of the timed runs
  double spread = 0;                          ///< half the difference between slowest and fastest, seconds
  std::optional<double> given_up_after = {};  ///< seconds after which the run was abandoned before it had ended
  std::string refused = {};  ///< the reason why it cannot be run here: its index does not fit in memory
};

struct Analysis {
  /// in the order of the ranking, then those without a closed form, then neighbours of the fastest
  std::vector<Analysed> candidates;
  int tried = 0;                    ///< number that were run to their end or abandoned
  std::optional<std::size_t> best;  ///< the fastest measured
  /// measured time of the predicted choice (the first candidate) divided by that of the best, minus 1
  std::optional<double> regret;
  bool stopped = false;  ///< true if some were not run and timed
};

struct AnalysisOptions {
  int repeats = 3;          ///< timed runs of each candidate that is not far behind, interleaved
  double patience = 5;      ///< a run is abandoned after this times the fastest so far, but at least 20 ms
  double far_behind = 2;    ///< a candidate slower than this times the fastest is timed only once
  std::size_t leaders = 2;  ///< number of candidates whose neighbours are tried
  std::stop_token stop = {};
  /// The models' prediction for a candidate that was not ranked; nothing if they have none.
  std::function<std::optional<model::Ranked>(const Candidate&)> predict = {};
  sim::ReportPhase progress = {};
};

/// Runs once, and counts, each ranked candidate, each exact technique that was not ranked, and neighbours of the
/// fastest. Then runs those that finished `repeats` times without counting, in turns, so that a disturbance of the
/// machine affects all alike. No candidate is left out because its prediction is slow: it is started, and abandoned
/// once it has taken `patience` times the fastest. The predicted choice is never abandoned.
[[nodiscard]] Analysis analyse(const sim::Problem& problem, const std::vector<model::Ranked>& ranking,
                               const AnalysisOptions& options = {});

}  // namespace detp::validate
