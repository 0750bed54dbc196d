#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "experiments.hpp"

/// Counts until the relative error of what is observed is small enough.
namespace detp::validate {

struct FindingsTarget {
  double relative_error = 0.01;  ///< half width of the interval, over the observed value
  double confidence = 0.95;      ///< that all intervals together hold
  double least_lines = 0;        ///< of each finding
  double most_lines = 1e10;      ///< of each finding
};

/// Throws std::invalid_argument unless errors and confidence are in (0, 1) and 0 <= least_lines <= most_lines.
void check(const FindingsTarget& target);

/// How far one finding got.
struct Refinement {
  double relative_error = 0;  ///< not finite if nothing was met
  bool reached = false;
  /// That the target would still take, by the error so far; infinite if nothing was met. Nothing if the target is reached, or if the
  /// finding counts on given rays.
  std::optional<double> more_lines = {};
  std::optional<double> more_seconds = {};
  /// If nothing was met: bound of the share of lines that meet anything, -ln(error allowed to this finding)/lines. Holds if lines are
  /// independent.
  std::optional<double> share_bound = {};
};

struct FindingsUntil {
  std::vector<Finding> findings;
  std::vector<Refinement> refinements;  ///< of each finding
  bool stopped = false;
};

/// Repeats each of the experiments that draws its lines, with other seeds, and takes the mean over the repetitions; its batches are those of
/// all. After the first repetition of all experiments, each is repeated as often as will reach the target by what is known, at most
/// eightfold in one stage; an experiment ends only after a stage that was planned to reach it. Test t of an experiment allows the error
/// (1 - confidence) 2/3ᵗ, shared over all findings of all experiments (Bonferroni), with Student's t for the batches. Asymptotic in the
/// size of a batch.
///
/// Claims that count on given rays, or exactly, are not repeated. A stop request ends the work with what is known. With a checkpoint,
/// goes on from `saved`, unless null, and writes the state now and then. Throws as check, CheckpointFile::write, and sim::FileError for
/// a damaged state.
[[nodiscard]] FindingsUntil findings_until(const Experiment& experiment, const FindingsTarget& target,
                                           const sim::ReportPhase& progress = {}, CheckpointFile* checkpoint = nullptr,
                                           const nlohmann::json& saved = {},
                                           std::span<const ExperimentStep> steps = experiment_steps());

}  // namespace detp::validate
