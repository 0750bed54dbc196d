#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "deviation.hpp"
#include "point.hpp"

/// The whole sweep: every formula over the whole range for which it is stated.
namespace detp::validate {

/// The measurements of a sweep so far, stored in a checkpoint file under the name of their point.
class Checkpoint {
 public:
  /// An empty checkpoint. `formulas` is a digest of formulas and points. A sweep can be continued only with an equal one.
  Checkpoint(std::filesystem::path path, std::uint64_t seed, const std::string& formulas);

  /// Reads the file. Throws as CheckpointFile. A missing file is an empty checkpoint.
  void read(std::stop_token stop = {});

  /// Adds a point and writes the file. Throws sim::FileError if it cannot be written.
  void add(const std::string& point, const std::vector<Deviation>& deviations);

  [[nodiscard]] const std::map<std::string, std::vector<Deviation>>& points() const { return points_; }

 private:
  CheckpointFile file_;
  std::map<std::string, std::vector<Deviation>> points_;
};

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
