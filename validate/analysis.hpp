#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "detp/model/choose.hpp"
#include "detp/sim/technique/technique.hpp"

/// A choice put to the test: the candidates run, counted and timed.
namespace detp::validate {

/// A candidate, predicted and (where it was run) counted and measured.
struct Analysed {
  model::Ranked predicted;
  std::optional<Counts<std::uint64_t>> counted = {};
  std::optional<double> seconds = {};  ///< median of the timed runs
  double spread = 0;                   ///< half the difference between slowest and fastest, seconds
};

struct Analysis {
  std::vector<Analysed> candidates;  ///< as ranked; the first is the choice
  std::optional<double> regret;      ///< measured time of the choice over that of the fastest measured, less 1
  bool stopped = false;              ///< not all was run
};

struct AnalysisOptions {
  int repeats = 3;       ///< timed runs of each candidate, interleaved
  double hopeless = 30;  ///< candidates predicted slower than this times the choice are not run
  std::stop_token stop = {};
  std::function<void(std::string_view what, double done)> progress = {};
};

/// Runs each ranked candidate once counting, and `repeats` times for time alone, in turns, so that a disturbance of the
/// machine hits all alike.
[[nodiscard]] Analysis analyse(const sim::Problem& problem, const std::vector<model::Ranked>& ranking,
                               const AnalysisOptions& options = {});

}  // namespace detp::validate
