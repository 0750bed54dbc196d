#pragma once

#include <stop_token>
#include <thread>

namespace detp::cli {

/// Turns Ctrl-C, a termination signal or the end of a time limit into a stop that is asked for, so that a command can
/// print what it has. A second Ctrl-C ends the program at once.
///
/// To be made before any other thread: they inherit that the signals are not theirs.
class Interruption {
 public:
  Interruption();

  /// Starts the clock: 0 or less is no limit.
  void limit(double seconds);

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  std::jthread signals_;
  std::jthread clock_;
};

}  // namespace detp::cli
