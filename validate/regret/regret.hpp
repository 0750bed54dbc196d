#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "choosers.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/bench/workload.hpp"
#include "detp/validate/measure/measure_all.hpp"

/// Measures the regret of choices: the time of what was chosen over the time of the best of all candidates.
namespace detp::validate {

/// Timed::judged_ratio() of a candidate to the best.
struct Regret {
  double value = 1;
  bool at_least = false;  ///< the candidate was abandoned, so this is a lower bound
};

/// What a tier chose for a workload.
struct ChoiceRow {
  std::string tier;
  Chosen choice;
  double seconds = 0;  ///< judging time; a lower bound if regret.at_least
  Regret regret;
  std::string reason;  ///< reason_of_regret()
};

/// The options of one baseline, in its order. nullopt: its index does not fit in memory.
using BaselineRow = std::vector<std::optional<Regret>>;

/// One workload with one number of threads.
struct RegretRow {
  BenchWorkload workload;
  double rays = 0;         ///< actual number, with all segments of photon paths
  double samples = 0;      ///< actual number
  double disc_radius = 0;  ///< in scene units
  int threads = 1;         ///< most threads
  Candidate best;
  int best_threads = 1;
  double best_seconds = 0;             ///< judging time
  double noise = 1;                    ///< Exhaustive::noise
  std::size_t tried = 0;               ///< number of candidates
  std::vector<ChoiceRow> choices;      ///< one for each tier
  std::vector<BaselineRow> baselines;  ///< in the order of baselines()

  [[nodiscard]] bool is_best(const Chosen& choice) const {
    return choice.prediction.candidate == best && choice.prediction.threads == best_threads;
  }
};

struct RegretOptions {
  CostTable costs;                ///< unit costs with which the reasons are found
  int threads = 1;                ///< most threads of each workload
  int more_threads = 0;           ///< unless 0: a fifth of the workloads also have this number
  ExhaustiveOptions search = {};  ///< its threads, stop and progress are not used
  std::uint64_t seed = 1;
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct RegretResult : SetProgress {
  std::vector<RegretRow> rows;
};

/// Whether the workload with this number is also run with RegretOptions::more_threads: one of five successive ones,
/// each time another one.
[[nodiscard]] constexpr bool has_more_threads(std::size_t place) { return place % 5 == place / 5 % 5; }

/// Runs the choosers and the exhaustive search on each workload. Skips a workload, with the reason, if it does not fit
/// in memory or if a chooser or technique refuses it. Throws as make_job does for a file that cannot be read.
[[nodiscard]] RegretResult run_regret(std::span<const BenchWorkload> workloads, std::span<const Chooser> choosers,
                                      const RegretOptions& options);

/// The reason why `choice` was chosen although `best` is faster, in a few words. The predicted times of the two are the
/// closed forms' for this workload, with these unit costs. Their errors are split by prediction_error() into counts and
/// unit costs. Only what differs between choice and best can change their order, so the reason is the part whose errors
/// differ most: counts, with the count that matters most, or unit costs. `noise` is Exhaustive::noise.
///
/// Empty if the two are the same. Other reasons: the difference is within the noise; the best has no closed form; the
/// best was predicted to be faster than the choice, so the ranking did not try it; the choice was abandoned; they differ
/// only in the number of threads.
[[nodiscard]] std::string reason_of_regret(const Workload& workload, const CostTable& costs, const Timed& choice,
                                           const Timed& best, double noise);

}  // namespace detp::validate
