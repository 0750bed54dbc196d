#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detp/validate/base/fields.hpp"
#include "detp/validate/bench/workload.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "regret.hpp"

/// How much slower the choices are than the best of all candidates: `detp bench --regret`.
namespace detp::validate {

struct Figures {
  std::size_t rows = 0;  ///< number of ratios; if it is 0, the other figures have no meaning
  double geometric_mean = 1;
  double p95 = 1;  ///< the quantile 0.95
  double worst = 1;
  std::size_t at_least = 0;  ///< number of ratios that are lower bounds; unless 0, the figures are lower bounds, too
};

/// The figures of these ratios, all > 0.
[[nodiscard]] Figures figures_of(std::span<const Regret> ratios);

/// The figures over all workloads, and over those that are fitted and held out (BenchWorkload::held_out).
struct RegretFigures {
  Figures all;
  Figures fitted;
  Figures held_out;
};

/// Relative errors |predicted - measured| / measured of the predicted seconds of choices that were not abandoned.
struct PredictionFigures {
  std::size_t rows = 0;  ///< if it is 0, the other figures have no meaning
  double median_error = 0;
  double p95_error = 0;
};

struct TierSummary {
  std::string tier;
  RegretFigures regret;
  Figures price;  ///< (choosing + run) over the best, where the best takes at least shortest_priced_run
  PredictionFigures prediction;
};

inline constexpr double shortest_priced_run = 0.005;  ///< seconds

struct BaselineSummary {
  std::size_t option = 0;  ///< index of the candidate with the smallest geometric mean on the fitted workloads
  RegretFigures regret;    ///< with that candidate on all workloads
};

/// The candidate of a baseline, one of baselines(), by its index; nullopt if it depends on the workload.
[[nodiscard]] std::optional<Candidate> candidate_of(std::size_t baseline, const BaselineSummary& summary);

struct RegretSummary {
  int threads = 1;
  std::size_t rows = 0;
  std::vector<TierSummary> tiers;
  std::vector<BaselineSummary> baselines;  ///< in the order of baselines()
  Figures noise;                           ///< of the larger of RegretRow::noise and its reciprocal
};

/// The summary of the rows with `threads` threads. All rows must have the same tiers.
[[nodiscard]] RegretSummary summarise(std::span<const RegretRow> rows, int threads);

/// The choice of a tier for a workload.
struct TierRow {
  const RegretRow* row;
  const ChoiceRow* choice;
  const RegretSummary* summary = nullptr;  ///< that selects the candidate of each baseline; null: without baselines
};

/// The choices with the largest regrets, worst first, at most `most` of them, without summaries. Leaves out choices that were the best.
[[nodiscard]] std::vector<TierRow> worst_choices(std::span<const RegretRow> rows, std::size_t most);

struct RegretRequest {
  BenchEffort effort = BenchEffort::quick;
  std::optional<std::uint64_t> families =
      {};                                 ///< seed of the scenes that replace those of the effort: family_workloads
  std::optional<std::string> scene = {};  ///< the workloads of this scene alone
  std::vector<sim::Field> fields = {};    ///< and of these fields; empty: all
  std::string scene_folder = {};          ///< of the meshes; empty: unknown
  std::string instruction_set = {};       ///< the only one of the kernels; empty: all that the machine has
  int threads = 0;  ///< 0: one; with the effort `thorough`, some workloads also have two where there are two cores
  CostRequest costs = {};
  std::uint64_t seed = 1;
};

struct RegretAnswer {
  BenchSet set;
  CostsInUse costs = {};
  std::vector<int> threads = {};
  RegretResult result = {};
  std::vector<RegretSummary> summaries = {};  ///< one for each number of threads

  /// The summaries of these results. All rows must have the same tiers.
  void summarise_all();
};

/// Before the work, `notice` gets the reason why a stored calibration is not used. Throws std::invalid_argument if there are no such workloads, and as
/// run_regret and costs_in_use do.
[[nodiscard]] RegretAnswer answer(const RegretRequest& request, const std::stop_token& stop = {},
                                  const sim::ReportPhase& progress = {}, const Notice& notice = {});

/// A row for each workload, number of threads and tier. They refer to the answer.
[[nodiscard]] std::vector<TierRow> tier_rows(const RegretAnswer& answer);

[[nodiscard]] const Fields<RegretAnswer>& regret_fields();
[[nodiscard]] const Fields<TierRow>& tier_fields();

/// Of regret_fields() and tier_fields().
[[nodiscard]] std::vector<FieldText> describe_regret();

inline constexpr std::size_t most_worst_choices = 10;  ///< number of choices that answers list as the worst

}  // namespace detp::validate
