#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace detp::sim {

/// Progress of some work: `done` of `of` units.
struct Progress {
  std::uint64_t done = 0;
  std::uint64_t of = 0;
  std::string_view unit = "rays";  ///< refers to a string of static storage
};

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
