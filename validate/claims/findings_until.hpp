#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/ranks/farm.hpp"
#include "detp/validate/checkpoint/value_json.hpp"
#include "experiments.hpp"

/// Counts until the relative error of what is observed is small enough; experiments that ranks share.
namespace detp::validate {

struct FindingsTarget {
  double relative_error = 0.01;  ///< half width of the interval, over the observed value
  double confidence = 0.95;      ///< that all intervals together hold
  double least_lines = 0;        ///< of each finding
  double most_lines = 1e10;      ///< of each finding
};

/// Throws std::invalid_argument unless errors and confidence are in (0, 1) and 0 <= least_lines <= most_lines.
void check(const FindingsTarget& target);

struct FindingsUntil {
  std::vector<Finding> findings;  ///< each with its refinement
  bool stopped = false;
};

/// Repeats each of the experiments that draws its lines, with other seeds, and takes the mean over the repetitions; its batches are those of
/// all. After the first repetition of all experiments, each is repeated as often as will reach the target by what is known, at most
/// eightfold in one stage; an experiment ends only after a stage that was planned to reach it. Test t of an experiment allows the error
/// (1 - confidence) 2/3ᵗ, shared over all findings of all experiments (Bonferroni), with Student's t for the batches. Asymptotic in the
/// size of a batch.
///
/// Claims that count on given rays, or exactly, are not repeated. A stop request ends the work with what is known. With a checkpoint,
/// writes the state to this file now and then, and if `resume`, goes on from it. Throws as check, CheckpointFile::read and ::write.
[[nodiscard]] FindingsUntil findings_until(const Experiment& experiment, const FindingsTarget& target,
                                           std::span<const ExperimentStep> steps = experiment_steps(),
                                           const std::optional<std::filesystem::path>& checkpoint = {},
                                           bool resume = false, const sim::ReportPhase& progress = {});

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FormulaValue, form, source, value)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, id, quantity, technique, parameters, predictions, observed, batches,
                                   tolerance, lines, seconds)

/// One of the experiments, and which of its repetitions: each has its own seed; number 0 has the experiment's.
struct Repetition {
  std::size_t step = 0;
  std::uint64_t number = 0;
};

struct FoundOnce {
  std::vector<Finding> findings;
  double seconds = 0;
  bool stopped = false;  ///< and has no findings
};

/// Runs experiments on the ranks of Experiment::ranks, or on this process alone.
class SharedFindings {
 public:
  /// Keeps references to both.
  SharedFindings(const Experiment& experiment, std::span<const ExperimentStep> steps);

  /// On rank 0. In the order of the repetitions. `costs`: as Farm::all.
  [[nodiscard]] std::vector<FoundOnce> find(const std::vector<Repetition>& repetitions,
                                            const std::vector<double>& costs = {});
  /// Repetitions that are found at the same time.
  [[nodiscard]] std::size_t at_once() const;
  /// On the other ranks. Returns when rank 0 has all that it needs.
  void serve() { farm_->serve(); }

 private:
  [[nodiscard]] FoundOnce find_here(const Repetition& repetition) const;

  const Experiment& experiment_;
  std::span<const ExperimentStep> steps_;
  sim::Farm::Work work_;
  std::optional<sim::Farm> farm_;
};

}  // namespace detp::validate
