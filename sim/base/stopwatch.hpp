#pragma once

#include <chrono>
#include <ctime>
#include <utility>

namespace detp::sim {

/// Seconds of the wall clock.
struct WallClock {
  [[nodiscard]] static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
};

/// Seconds of processor time that this process used on all its threads. Other processes on the machine hardly affect
/// it.
struct ProcessorClock {
  [[nodiscard]] static double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
};

/// Seconds since construction or since the last lap.
template <class Clock>
class StopwatchOf {
 public:
  [[nodiscard]] double seconds() const { return Clock::now() - start_; }

  /// The seconds so far; restarts the stopwatch.
  [[nodiscard]] double lap() {
    const double now = Clock::now();
    return now - std::exchange(start_, now);
  }

 private:
  double start_ = Clock::now();
};

using Stopwatch = StopwatchOf<WallClock>;
using ProcessorStopwatch = StopwatchOf<ProcessorClock>;

}  // namespace detp::sim
