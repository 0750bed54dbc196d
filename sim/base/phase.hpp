#pragma once

#include <functional>
#include <string>
#include <utility>

/// How long work reports what it is doing, for a display of its progress.
namespace detp::sim {

/// A part of some work. `from` and `to` are shares of the whole work, 0 to 1, in proportion to predicted time.
struct Phase {
  std::string what;    ///< "making rays"
  double from = 0;     ///< done before this phase
  double to = 0;       ///< done after it
  double work = 0;     ///< predicted units of work in between, as StopCheck counts them; 0: not known
  double seconds = 0;  ///< predicted time in between, where the work is not known; 0: not known either
};

/// Called at the beginning of each phase, by any thread. May be empty.
using ReportPhase = std::function<void(const Phase&)>;

/// Phases of a part of the work that lies between two shares of the whole. Empty if `whole` is.
[[nodiscard]] inline ReportPhase part_of(ReportPhase whole, double from, double to) {
  if (!whole) return {};
  return [whole = std::move(whole), from, to](const Phase& phase) {
    whole({phase.what, from + (to - from) * phase.from, from + (to - from) * phase.to, phase.work, phase.seconds});
  };
}

}  // namespace detp::sim
