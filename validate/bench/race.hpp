#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/validate/bench/peer/embree_peer.hpp"
#include "detp/validate/job/job.hpp"

/// A race: competitors take turns on the same rays and discs.
namespace detp::validate {

/// The right hits of each disc, and the technique that determined them.
struct RightHits {
  Technique judge = Technique::brute_force;
  std::vector<std::uint64_t> hits;

  /// Sum of |others - right hits| over the discs.
  [[nodiscard]] std::uint64_t wrong_hits(std::span<const std::uint64_t> others) const;
};

/// The hits of brute force, or of the candidate `exact` if rays × discs exceeds `checkable`. Throws sim::Stopped
/// on a stop request.
[[nodiscard]] RightHits right_hits(const Job& job, const Candidate& exact, double checkable,
                                   const std::stop_token& stop = {});

/// What we choose ourselves, by a pilot, in each run anew. Choosing is part of the run.
struct OwnChoice {};

/// One of our techniques with parameters, Embree in one of its modes, or our choice.
using Competitor = std::variant<Candidate, EmbreeMode, OwnChoice>;

[[nodiscard]] inline bool is_own_technique(const Competitor& competitor) {
  return std::holds_alternative<Candidate>(competitor);
}
[[nodiscard]] inline bool is_embree(const Competitor& competitor) {
  return std::holds_alternative<EmbreeMode>(competitor);
}

/// "sphere-tree", "embree" or "choice".
[[nodiscard]] std::string technique_of(const Competitor& competitor);

/// The parameters as text, or Embree's mode; nothing for our choice.
[[nodiscard]] std::string parameters_of(const Competitor& competitor);

struct CompetitorResult {
  Competitor competitor;
  /// of each run (OwnTime), from discs and rays in memory to irradiance in memory
  std::vector<double> seconds = {};
  std::uint64_t hits = 0;        ///< hits on all discs in the last run
  std::uint64_t wrong_hits = 0;  ///< RightHits::wrong_hits, the maximum over the runs

  [[nodiscard]] double median_seconds() const;
};

struct RaceOptions {
  int repeats = 5;          ///< maximum number of rounds
  double most_seconds = 2;  ///< after this many seconds, no fourth or later round starts
  int finalists = 2;        ///< number of competitors of each side that run after the first round
  int threads = 1;
  CostTable costs = {};  ///< with which our choice is made
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct Race {
  std::vector<CompetitorResult> results;  ///< of all competitors that ran at least once, in the order of the input
  bool complete = false;                  ///< true if all competitors ran at least once
};

/// Runs all competitors in turn, round after round, so that a disturbance of the machine affects all alike. After the
/// first round, only the `finalists` fastest of our techniques and of Embree's modes, and our choice, continue, because a more accurate
/// time of a slower competitor would not change the result. Every run's hits are compared with the right hits after the
/// time has been taken.
///
/// Embree uses the threads of `embree`; their number should equal options.threads.
[[nodiscard]] Race race(const Job& job, const RightHits& right, const EmbreePeer& embree,
                        const std::vector<Competitor>& competitors, const RaceOptions& options);

}  // namespace detp::validate
