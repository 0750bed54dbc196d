#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/validate/bench/peer/embree_peer.hpp"
#include "referee.hpp"

/// A race: competitors take turns on the same rays and discs.
namespace detp::validate {

/// One of our techniques with parameters, or Embree in one of its modes.
using Competitor = std::variant<Candidate, EmbreeMode>;

[[nodiscard]] inline bool is_own_technique(const Competitor& competitor) {
  return std::holds_alternative<Candidate>(competitor);
}

/// "sphere-tree", or "embree".
[[nodiscard]] std::string technique_of(const Competitor& competitor);

/// The parameters as text, or Embree's mode.
[[nodiscard]] std::string parameters_of(const Competitor& competitor);

struct CompetitorResult {
  Competitor competitor;
  std::vector<double> seconds = {};  ///< of each run, from discs and rays in memory to irradiance in memory
  std::uint64_t hits = 0;            ///< hits on all discs in the last run
  std::uint64_t wrong_hits = 0;      ///< RightHits::wrong_hits, the maximum over the runs

  [[nodiscard]] double median_seconds() const;
};

struct RaceOptions {
  int repeats = 5;          ///< maximum number of rounds
  double most_seconds = 2;  ///< after this many seconds, no fourth or later round starts
  int finalists = 2;        ///< number of competitors of each side that run after the first round
  int threads = 1;
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct Race {
  std::vector<CompetitorResult> results;  ///< of all competitors that ran at least once, in the order of the input
  bool complete = false;                  ///< true if all competitors ran at least once
};

/// Runs all competitors in turn, round after round, so that a disturbance of the machine affects all alike. After the
/// first round, only the `finalists` fastest of our techniques and of Embree's modes continue, because a more accurate
/// time of a slower competitor would not change the result. Every run's hits are compared with the right hits after the
/// time has been taken.
///
/// Embree uses the threads of `embree`; their number should equal options.threads.
[[nodiscard]] Race race(const Job& job, const RightHits& right, const EmbreePeer& embree,
                        const std::vector<Competitor>& competitors, const RaceOptions& options);

}  // namespace detp::validate
