#pragma once

#include <optional>
#include <vector>

#include "detp/validate/accuracy/accuracy_check.hpp"
#include "detp/validate/checkpoint/checkpoint_file.hpp"

/// What `detp accuracy` has found so far, in a checkpoint.
namespace detp::cli {

struct SavedAccuracy {
  std::optional<validate::AccuracyPilot> pilot = {};
  std::optional<validate::AccuracyCheck> check = {};
  double planning_seconds = 0;  ///< of pilots and check
  std::vector<validate::MadeRerun> runs = {};
};

/// Nothing is saved if there is no file. Throws as CheckpointFile::read.
[[nodiscard]] SavedAccuracy read_accuracy(const validate::CheckpointFile& file, const std::stop_token& stop);

/// Throws as CheckpointFile::write.
void write_accuracy(validate::CheckpointFile& file, const SavedAccuracy& saved);

}  // namespace detp::cli
