#pragma once

#include <array>
#include <vector>

#include "calibrate.hpp"

/// Fits all costs of a calibration to its runs.
namespace detp::validate {

/// The runs of one technique by one engine.
struct TechniqueRuns {
  std::vector<TimedRun> on_one_thread;
  std::vector<ThreadedRun> on_more;
};

class TimedRuns {
 public:
  [[nodiscard]] TechniqueRuns& of(Engine engine, Technique technique) {
    return runs_[static_cast<std::size_t>(engine)][static_cast<std::size_t>(technique)];
  }
  [[nodiscard]] const TechniqueRuns& of(Engine engine, Technique technique) const {
    return runs_[static_cast<std::size_t>(engine)][static_cast<std::size_t>(technique)];
  }

 private:
  std::array<std::array<TechniqueRuns, all_techniques.size()>, 2> runs_;  ///< by engine
};

/// Sets the costs, their fits and errors. Techniques with too few runs get the built-in costs, and the error of all.
void fit_all(const TimedRuns& runs, Calibration& result);

}  // namespace detp::validate
