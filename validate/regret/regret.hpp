#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/validate/bench/workload.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"
#include "detp/validate/measure/measure_all.hpp"

/// The ways to choose a candidate (tiers, and simple rules that need no cost model), and the regret of their choices: the time of what was
/// chosen over the time of the best of all candidates.
namespace detp::validate {

/// What a tier chose.
struct Chosen {
  Prediction prediction;        ///< of a run with the candidate
  double choosing_seconds = 0;  ///< time that choosing took

  /// Of a repeated run; nothing if it was not predicted, only guessed.
  [[nodiscard]] std::optional<double> predicted_seconds() const {
    const bool known = prediction.source != Source::guess && prediction.time.again() > 0;
    return known ? std::optional(prediction.time.again()) : std::nullopt;
  }
};

struct Chooser {
  std::string name;  ///< of the tier: "estimate"
  std::function<Chosen(const sim::Problem&, const Job&, int most_threads)> choose;
};

/// All tiers, one line each in regret.cpp. `costs` are the unit costs with which they predict times.
///
///     pilot      choose, with a prediction; choosing_seconds do not include sorting the discs, which the run needs anyway
///     run        the same for one search, as in `detp run`: short ones take the usual shape, with no prediction
///     structural choose with structural rigor; choosing_seconds include those of measuring the workload, but not the sorting
///     estimate   choose by closed forms; choosing_seconds include those of measuring the workload
///     measure    analyse, from the candidates of a pilot; predicted are the measured seconds
[[nodiscard]] std::vector<Chooser> all_choosers(const CostTable& costs);

struct Baseline {
  std::string_view name;  ///< in results: "best_constant"
  std::string_view text;  ///< "best constant"
  bool by_workload;       ///< the candidates differ from workload to workload
  /// The candidates of the rule on a workload, of which one counts: the one with the smallest geometric mean of its
  /// regrets on the fitted workloads. Always the same number.
  std::vector<Candidate> (*candidates)(const Workload&);
};

/// best constant        box trees with a fan-out of 4, 8 or 16 and leaves of 16 or 64
/// usual shape          box tree with the shape of usual_shape()
/// paper's rule         model::paper_rule
/// always Embree        bvh with quality low or medium
/// always brute force   brute-force
[[nodiscard]] const std::array<Baseline, 5>& baselines();

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
