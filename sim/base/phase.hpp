#pragma once

#include <functional>
#include <string>
#include <utility>

/// How long-running work reports its current phase, for a display of progress.
namespace detp::sim {

/// A phase of some work. `from` and `to` are shares of the whole work, 0 to 1, in proportion to predicted time.
struct Phase {
  std::string what;    ///< "making rays"
  double from = 0;     ///< share done before this phase
  double to = 0;       ///< share done after this phase
  double work = 0;     ///< predicted units of work of this phase, as StopCheck counts them; 0: unknown
  double seconds = 0;  ///< predicted time of this phase if the work is unknown; 0: unknown too
};

/// Called at the beginning of each phase, by any thread. May be empty.
using ReportPhase = std::function<void(const Phase&)>;

/// Returns a function that passes the phases of part [from, to] of the work to `whole`. Empty if `whole` is empty.
[[nodiscard]] inline ReportPhase part_of(ReportPhase whole, double from, double to) {
  if (!whole) return {};
  return [whole = std::move(whole), from, to](const Phase& phase) {
    whole({phase.what, from + (to - from) * phase.from, from + (to - from) * phase.to, phase.work, phase.seconds});
  };
}

}  // namespace detp::sim
