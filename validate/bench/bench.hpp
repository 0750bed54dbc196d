#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/phase.hpp"
#include "detp/validate/bench/peer/embree_peer.hpp"
#include "detp/validate/job/job.hpp"
#include "workload.hpp"

/// Races of our techniques and Embree over a set of workloads: competitors take turns on the same rays and discs.
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
  int threads = 1;
  std::optional<CostTable> costs = {};  ///< with which our choice is made, if it takes part
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct Race {
  std::vector<CompetitorResult> results;  ///< of all competitors that ran at least once, in the order of the input
  bool complete = false;                  ///< true if all competitors ran at least once
};

/// Runs all competitors in turn, round after round, so that a disturbance of the machine affects all alike. After the
/// first round, only the two fastest of our techniques and of Embree's modes, and our choice, continue, because a more accurate
/// time of a slower competitor would not change the result. Every run's hits are compared with the right hits after the
/// time has been taken.
///
/// Embree uses the threads of `embree`; their number should equal options.threads. Null if no competitor is a mode of Embree.
[[nodiscard]] Race race(const Job& job, const RightHits& right, const EmbreePeer* embree,
                        const std::vector<Competitor>& competitors, const RaceOptions& options);

struct BenchOptions {
  /// of each; `threads` is not used, and `progress` is that of the whole. Our choice takes part if there are costs, where float kernels can search
  RaceOptions race = {};
  std::vector<Technique> techniques = {};  ///< our techniques to run; empty: all exact techniques
  std::vector<EmbreeMode> embree_modes = {};
  std::vector<int> threads = {1};    ///< each workload is run with each of these numbers of threads
  std::string instruction_set = {};  ///< of our kernels and of Embree; empty: all that the machine has
  double most_hits = 5e6;            ///< a workload is skipped if more hits are expected
  std::uint64_t seed = 1;
};

/// Whose times are compared with Embree's: our fastest technique's, or those of our choice, with choosing.
enum class Ours { best, choice };

struct BenchEntry {
  BenchWorkload workload;
  double samples = 0;      ///< actual number of samples
  double disc_radius = 0;  ///< in scene units
  int threads = 1;
  std::string instruction_set = {};          ///< of our kernels
  Technique judge = Technique::brute_force;  ///< the technique whose hits count as right
  Race race;

  /// Our fastest technique if `ours`, else Embree's fastest mode; null if none has run.
  [[nodiscard]] const CompetitorResult* best(bool ours) const;

  /// Our choice; null if it did not take part.
  [[nodiscard]] const CompetitorResult* choice() const;

  /// Embree's best time divided by ours; nothing if either is unknown or the race is incomplete.
  [[nodiscard]] std::optional<double> ratio(Ours ours = Ours::best) const;
};

struct BenchResult : SetProgress {
  std::vector<BenchEntry> entries;
};

/// Runs a race on each workload. Throws as make_job does for a wrong scene or number, and std::invalid_argument for an instruction set
/// that this machine or Embree lacks. No other search may run meanwhile if one is named.
[[nodiscard]] BenchResult run_bench(std::span<const BenchWorkload> workloads, const BenchOptions& options);

/// The six modes that `bench` runs by default. All 60 modes were measured on seven workloads (CPU time, 10³ … 10⁵
/// rays). The fastest of these six was the fastest of all modes on five workloads, at most 1 % slower than the fastest
/// on one, and 5 % slower on one where each mode ran only once. The times of all 60 modes are close: on discs the
/// quality, the coherent flag and packets matter little. rtcOccluded, which keeps no nearest hit, is 1 to 5 % faster
/// than rtcIntersect.
[[nodiscard]] std::vector<EmbreeMode> best_embree_modes();

}  // namespace detp::validate
