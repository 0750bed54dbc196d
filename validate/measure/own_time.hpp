#pragma once

#include <algorithm>

#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {

/// Measures how long a run takes apart from what other programs take: on one thread, the seconds of the processor or of the
/// wall clock, whichever are fewer; on several threads, of the wall clock.
class OwnTime {
 public:
  explicit OwnTime(int threads) : one_thread_(threads == 1) {}

  [[nodiscard]] double seconds() const { return own_part_of(wall_.seconds()); }

  /// `wall` are the seconds of the whole run, or of a part of it, by the wall clock.
  [[nodiscard]] double own_part_of(double wall) const {
    return one_thread_ ? std::min(wall, processor_.seconds()) : wall;
  }

 private:
  bool one_thread_;
  sim::Stopwatch wall_;
  sim::ProcessorStopwatch processor_;
};

}  // namespace detp::validate
