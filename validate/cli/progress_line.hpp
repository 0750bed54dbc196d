#pragma once

#include <memory>
#include <string>

#include "command.hpp"
#include "detp/sim/base/phase.hpp"

/// Progress on a terminal.
namespace detp::cli {

/// Seconds as a reader takes them in: "12 s", "3 min", "1 h 10 min".
[[nodiscard]] std::string duration_text(double seconds);

/// Shows on the last line of a terminal what is being done, how much of the work is done and how long the rest will
/// take; nothing elsewhere, or if quiet. Wiped when it goes out of scope. May be used from several threads.
///
/// Between the reports of phases it moves with the work that StopCheck counts. The time left is that of the speed since
/// half of the time: phases that were predicted badly in relation to each other are soon forgotten.
class ProgressLine {
 public:
  explicit ProgressLine(const CommonOptions& common);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const sim::Phase& phase) const;

  /// A report for library calls; empty where nothing is shown. It must not outlive this object.
  [[nodiscard]] sim::ReportPhase report() const;

 private:
  class Display;
  std::unique_ptr<Display> display_;  ///< null where nothing is shown
};

}  // namespace detp::cli
