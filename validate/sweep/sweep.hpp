#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "deviation.hpp"
#include "point.hpp"

/// The whole sweep: every formula over the whole range for which it is stated.
namespace detp::validate {

struct SweepOptions {
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> checkpoint{};  ///< written, atomically, after each point
  bool resume = false;  ///< reuse the measurements in the checkpoint; a missing file has none
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct SweepResult {
  std::vector<Deviation> deviations;  ///< by point, in the order of the points
  std::size_t points = 0;             ///< number of requested points
  std::size_t measured = 0;           ///< number of points with results, < points if the sweep was stopped
  std::size_t resumed = 0;            ///< number of points read from the checkpoint
};

/// Measures the points in parallel, each on one thread, and starts them in their order. The same seed gives the same
/// result, whether or not the sweep was resumed. After a stop request, the result has the points that were finished.
///
/// Throws sim::FileError if the checkpoint cannot be read or written, is malformed, or was made with another seed or
/// another version of the sweep. The checkpoint is then left unchanged.
[[nodiscard]] SweepResult run_sweep(std::span<const SweepPoint> points, const SweepOptions& options = {});

/// Checks the checkpoint in the options without measuring anything. Throws as run_sweep does for the checkpoint, and
/// sim::Stopped within 0.1 s of a stop request.
void check_checkpoint(std::span<const SweepPoint> points, const SweepOptions& options);

}  // namespace detp::validate
