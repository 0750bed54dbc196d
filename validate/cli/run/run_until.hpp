#pragma once

#include <functional>
#include <optional>
#include <string>

#include "detp/sim/scene/selection.hpp"
#include "detp/validate/stopping/execute_until.hpp"
#include "run_report.hpp"
#include "timed_run.hpp"

/// Runs until an error is reached: `detp run --target-noise` and `--target-error`.
namespace detp::cli {

struct TargetOptions {
  std::optional<std::string> noise;
  std::optional<std::string> error;
  std::string confidence = "95%";
  std::optional<std::string> checkpoint;
  bool resume = false;
  sim::FaceNames faces;  ///< whose samples the error is of; none: all

  [[nodiscard]] bool given() const { return noise || error; }
  /// Without bias. Throws std::invalid_argument for both targets, and for numbers out of (0, 1).
  [[nodiscard]] validate::ErrorTarget target() const;
};

/// Rays of the job of such a run, with which it begins: `--rays` is the limit.
[[nodiscard]] double first_rays(std::optional<double> most_rays);

/// How a run until an error comes to its candidate.
struct CandidateOfRun {
  std::function<Requested()> choose;  ///< where there is no checkpoint to go on from
  /// What the user asked for by name and the checkpoint's candidate is not, in words; empty if it is all of it.
  std::function<std::string(const Candidate&)> missing;
};

/// Fills in the answer's candidate, outcome, times and `until`. Goes on from the checkpoint, with its candidate, if it is to resume; keeps
/// one, also when it is stopped. `answer` has the estimator. The job has its scene, if photons were traced in one. Ranks share the rays
/// that follow the job's own.
void run_to_target(RunAnswer& answer, const validate::Job& job, const TargetOptions& options, double most_rays,
                   const CandidateOfRun& candidate, int threads, const std::stop_token& stop,
                   const sim::ReportPhase& progress, sim::Ranks* ranks = nullptr);

/// What the JSON of a run has in addition.
[[nodiscard]] Json to_json(const UntilAnswer& until);

/// The first lines of the text.
[[nodiscard]] std::string until_text(const UntilAnswer& until, double side);

}  // namespace detp::cli
