#pragma once

#include <memory>
#include <string>

#include "detp/sim/base/phase.hpp"

/// The progress line on a terminal.
namespace detp::cli {

/// Formats a duration with one or two units: "12 s", "3 min", "1 h 10 min".
[[nodiscard]] std::string duration_text(double seconds);

/// Shows the current phase, the share of the work done and the time left on the last line of a terminal. Shows nothing
/// if stderr is not a terminal, or if `quiet`. The destructor erases the line. Several threads may use one object.
///
/// Between reports of phases, the share advances with the work that StopCheck counts. The time left is computed from
/// the speed in the second half of the elapsed time, so errors in the predicted work of earlier phases soon have no
/// effect.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const sim::Phase& phase) const;

  /// Returns the callback for library calls; empty if nothing is shown. The callback must not outlive this object.
  [[nodiscard]] sim::ReportPhase report() const;

 private:
  class Display;
  std::unique_ptr<Display> display_;  ///< null if nothing is shown
};

}  // namespace detp::cli
