#pragma once

#include <stdexcept>
#include <string>

#include "progress.hpp"

namespace detp::sim {

/// Thrown when a stop request (Ctrl-C, a time limit) ends some work before it has a result. The message says how far
/// the work got: "stopped while reading rays.csv after 12000 lines".
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(const std::string& message, Progress progress = {}) : runtime_error(message), progress_(progress) {}

  /// The progress in numbers; Progress::of is 0 if the progress is not known.
  [[nodiscard]] const Progress& progress() const { return progress_; }

 private:
  Progress progress_;
};

}  // namespace detp::sim
