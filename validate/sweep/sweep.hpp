#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "deviation.hpp"
#include "point.hpp"

/// The whole sweep: every formula over the whole range for which it is stated.
namespace detp::validate {

struct SweepOptions {
  std::uint64_t seed = 1;
  std::optional<std::filesystem::path> checkpoint{};  ///< written, atomically, after each point
  bool resume = false;                                ///< takes from the checkpoint what it holds; it may be missing
  std::stop_token stop = {};
  std::function<void(std::string_view done, double share)> progress = {};
};

struct SweepResult {
  std::vector<Deviation> deviations;  ///< by point, in their order
  std::size_t points = 0;             ///< asked for
  std::size_t measured = 0;           ///< of them: fewer where it was stopped
  std::size_t resumed = 0;            ///< taken from the checkpoint
};

/// Measures the points, in parallel, one thread each, the first ones first. The same seed gives the same result, in one
/// go or resumed.
///
/// Throws sim::FileError for a checkpoint that cannot be read or written, was made with another seed or another version
/// of the sweep, or is malformed: it is left as it is.
[[nodiscard]] SweepResult run_sweep(std::span<const SweepPoint> points, const SweepOptions& options = {});

/// Throws as run_sweep does for the checkpoint that the options name, without any measuring;
/// and sim::Stopped within 0.1 s of a stop request.
void check_checkpoint(std::span<const SweepPoint> points, const SweepOptions& options);

}  // namespace detp::validate
