#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/technique/technique.hpp"

/// A choice put to the test: the candidates run, counted and timed.
namespace detp::validate {

/// A candidate, predicted (where there is a closed form of it) and, where it was run to its end, counted and measured.
struct Analysed {
  Candidate candidate;
  std::optional<model::Ranked> predicted = {};
  std::optional<Counts<std::uint64_t>> counted = {};
  std::optional<double> seconds = {};         ///< median of the timed runs
  double spread = 0;                          ///< half the difference between slowest and fastest, seconds
  std::optional<double> given_up_after = {};  ///< seconds: it took that long and had not ended
  std::string refused = {};                   ///< why it cannot be run here: an index that does not fit the memory
};

struct Analysis {
  std::vector<Analysed> candidates;  ///< as ranked, then those that have no closed form, then neighbours of the fastest
  int tried = 0;                     ///< that were run to their end or given up
  std::optional<std::size_t> best;   ///< the fastest measured
  std::optional<double> regret;  ///< measured time of the predicted choice, the first, over that of the best, less 1
  bool stopped = false;          ///< not all were run and timed
};

struct AnalysisOptions {
  int repeats = 3;          ///< timed runs of each candidate that is not far behind, interleaved
  double patience = 5;      ///< a run is given up after this times the fastest so far (but after 20 ms at least) …
  double far_behind = 2;    ///< … and beyond this times the fastest it is timed once
  std::size_t leaders = 2;  ///< candidates whose neighbours are tried
  std::stop_token stop = {};
  /// What the models say of a candidate that was not ranked; nothing where they say nothing.
  std::function<std::optional<model::Ranked>(const Candidate&)> predict = {};
  std::function<void(std::string_view what, double done)> progress = {};
};

/// Runs each ranked candidate, each exact technique that was not ranked and neighbours of the fastest once, counting;
/// then those that came to their end `repeats` times for time alone, in turns, so that a disturbance of the machine
/// hits all alike. No candidate is left out because a prediction says that it is slow: it is started, and given up once
/// it has taken `patience` times the fastest. The predicted choice is never given up.
[[nodiscard]] Analysis analyse(const sim::Problem& problem, const std::vector<model::Ranked>& ranking,
                               const AnalysisOptions& options = {});

}  // namespace detp::validate
