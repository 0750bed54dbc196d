#pragma once

#include <vector>

#include "command.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/choice/job.hpp"

namespace detp::cli {

/// A run over all rays of a job, whether they are in memory or a stream.
struct TimedRun {
  sim::Outcome outcome;
  double prepare_seconds = 0;      ///< checking rays and discs, S₀
  double read_seconds = 0;         ///< making the rays of a stream
  std::size_t rays_in_memory = 0;  ///< at a time
};

[[nodiscard]] TimedRun run_job(const validate::Job& job, const Candidate& candidate, const sim::RunOptions& options,
                               const ProgressLine& progress);

/// From discs and rays in memory to irradiance in memory, in seconds.
struct Timing {
  sim::Phases phases;
  double prepare = 0;
  std::vector<double> all;  ///< totals of all timed runs

  [[nodiscard]] double total() const { return prepare + phases.total(); }
};

/// The timed runs: the counting one itself, or `repeat` others that do nothing but find hits; the median of them, of an
/// even number the slower of the two in the middle: its phases are those of one run.
[[nodiscard]] Timing time_runs(const validate::Job& job, const Candidate& candidate, const TimedRun& counted,
                               int repeat, const sim::RunOptions& options, const ProgressLine& progress);

}  // namespace detp::cli
