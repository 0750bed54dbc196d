#pragma once

#include <stdexcept>
#include <string>

#include "progress.hpp"

namespace detp::sim {

/// Work that was ended by a stop request (Ctrl-C, a time limit) before it had a result. The message says how far it
/// came: "stopped while reading rays.csv after 12000 lines".
class Stopped : public std::runtime_error {
 public:
  explicit Stopped(const std::string& message, Progress progress = {}) : runtime_error(message), progress_(progress) {}

  /// The same in numbers; of 0 units where that is not known.
  [[nodiscard]] const Progress& progress() const { return progress_; }

 private:
  Progress progress_;
};

}  // namespace detp::sim
