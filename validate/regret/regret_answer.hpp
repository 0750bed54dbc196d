#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "detp/validate/base/fields.hpp"
#include "detp/validate/bench/workload_sets.hpp"
#include "detp/validate/calibration/costs_in_use.hpp"
#include "regret_summary.hpp"

/// How much slower the choices are than the best of all candidates: `detp bench --regret`.
namespace detp::validate {

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

/// `notice` is told before the work why a stored calibration is not used. Throws std::invalid_argument if there are no such workloads, and as
/// run_regret and costs_in_use do.
[[nodiscard]] RegretAnswer answer(const RegretRequest& request, const std::stop_token& stop = {},
                                  const sim::ReportPhase& progress = {}, const Notice& notice = {});

/// The choice of a tier for a workload.
struct TierRow {
  const RegretRow* row;
  const ChoiceRow* choice;
  const RegretSummary* summary = nullptr;  ///< that selects the candidate of each baseline; null: without baselines
};

/// A row for each workload, number of threads and tier. They refer to the answer.
[[nodiscard]] std::vector<TierRow> tier_rows(const RegretAnswer& answer);

[[nodiscard]] const Fields<RegretAnswer>& regret_fields();
[[nodiscard]] const Fields<TierRow>& tier_fields();

/// Of regret_fields() and tier_fields().
[[nodiscard]] std::vector<FieldText> describe_regret();

inline constexpr std::size_t most_worst_choices = 10;  ///< number of choices that answers list as the worst

}  // namespace detp::validate
