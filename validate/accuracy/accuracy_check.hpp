#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "accuracy_plan.hpp"

/// Runs of a plan's answer. Errors are taken at the samples of AccuracyPilotOptions::reference, or else at the scene's; seconds are for all
/// of the scene's samples.
namespace detp::validate {

/// One run of a point, and what it took.
struct AccuracyCheck {
  AccuracyPoint point = {};  ///< as it was predicted
  double noise = 0;          ///< from the difference between the run and its first half
  double seconds = 0;        ///< tracing and estimating, with all that has to be built
  double trace_seconds = 0;  ///< of these
  double rays = 0;
  /// Error against the reference, its variance subtracted; nothing without one.
  std::optional<double> error = {};
  /// Share of the reference's samples whose error is at most `within` times the root mean square irradiance; nothing without one.
  std::optional<double> share_within = {};
};

/// Throws as sim::estimate; sim::Stopped on a stop request.
[[nodiscard]] AccuracyCheck check_accuracy(sim::Scene& scene, const AccuracyPoint& point, double mean_square,
                                           const AccuracyPilotOptions& options, double within = 0.05);

/// The pilot with what the check says of the noise of the point's estimator: the mean of both by their rays. A plan from it ranks again.
[[nodiscard]] AccuracyPilot with_check(AccuracyPilot pilot, const AccuracyCheck& check);

/// One of many runs of a plan's answer.
struct AccuracyRerun {
  std::uint64_t seed = 0;
  double seconds = 0;
  std::optional<double> error = {};     ///< as AccuracyCheck::error
  std::vector<double> irradiance = {};  ///< at the samples where noise is taken
  /// Root mean square difference from the mean of all runs, times √(R/(R - 1)); 0 before all are made.
  double noise = 0;
};

/// The seeds of runs, from the first to the last.
struct RerunSeeds {
  std::uint64_t first = 1;
  std::uint64_t last = 1;

  [[nodiscard]] std::uint64_t count() const { return last - first + 1; }
};

/// Throws std::invalid_argument unless there are 2 to 1e6 seeds.
void check(const RerunSeeds& seeds);

/// Runs a point with each of the seeds; those `made` before are the first. Noise is taken at up to 10 000 of the samples. Ends early, with
/// the runs made so far, on a stop request; nothing if these are fewer than two. Calls `save` after each run, or as many as there are ranks,
/// which share the runs. Throws as check and sim::estimate, and std::invalid_argument if runs that were made are not the first ones, or at
/// other samples.
[[nodiscard]] std::vector<AccuracyRerun> rerun_accuracy(
    sim::Scene& scene, const AccuracyPoint& point, double mean_square, const RerunSeeds& seeds,
    const AccuracyPilotOptions& options, std::vector<AccuracyRerun> made = {},
    const std::function<void(const std::vector<AccuracyRerun>&)>& save = {});

/// On ranks other than 0 of options.ranks: makes the runs that rerun_accuracy on rank 0 hands out, until it has all.
void serve_reruns(sim::Scene& scene, const AccuracyPilotOptions& options);

}  // namespace detp::validate
