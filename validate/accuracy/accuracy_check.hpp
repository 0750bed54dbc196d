#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "accuracy_plan.hpp"

/// Runs of a plan's answer. Errors are taken at the samples of AccuracyPilotOptions::reference, or else at the scene's; seconds are for all
/// of the scene's samples.
namespace detp::validate {

/// What one run takes.
struct AccuracyCheck {
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
[[nodiscard]] AccuracyPilot with_check(AccuracyPilot pilot, const AccuracyPoint& point, const AccuracyCheck& check);

/// One of many runs of a plan's answer.
struct AccuracyRerun {
  std::uint64_t seed = 0;
  double noise = 0;  ///< root mean square difference from the mean of all runs, times √(R/(R - 1))
  double seconds = 0;
  std::optional<double> error = {};  ///< as AccuracyCheck::error
};

/// A run before all are made.
struct MadeRerun {
  std::uint64_t seed = 0;
  double seconds = 0;
  std::optional<double> error = {};
  std::vector<double> irradiance;  ///< at the samples where noise is taken
};

/// How many seeds there are. Throws std::invalid_argument unless they are 2 to 1e6.
std::uint64_t check_seeds(std::uint64_t first, std::uint64_t last);

/// Runs a point with the seeds from `first` to `last`, of which `made` are the first. Noise is taken at up to 2000 of the samples. Ends
/// early, with the runs made so far, on a stop request. Calls `save` after each run, or as many as there are
/// ranks, which share the runs. Throws as check_seeds and sim::estimate, and
/// std::invalid_argument if runs that were made are not the first ones, or at other samples.
[[nodiscard]] std::vector<AccuracyRerun> rerun_accuracy(
    sim::Scene& scene, const AccuracyPoint& point, double mean_square, std::uint64_t first, std::uint64_t last,
    const AccuracyPilotOptions& options, std::vector<MadeRerun> made = {},
    const std::function<void(const std::vector<MadeRerun>&)>& save = {});

/// On ranks other than 0 of options.ranks: makes the runs that rerun_accuracy on rank 0 hands out, until it has all.
void serve_reruns(sim::Scene& scene, const AccuracyPilotOptions& options);

}  // namespace detp::validate
