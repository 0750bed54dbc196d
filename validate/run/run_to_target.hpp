#pragma once

#include <functional>
#include <string>

#include "run.hpp"

/// Runs until an error is reached.
namespace detp::validate {

/// Rays of the job of such a run, with which it begins.
[[nodiscard]] double first_rays(double most_rays);

/// How a run until an error comes to its candidate.
struct CandidateOfRun {
  std::function<RunCandidate()> choose;  ///< where there is no checkpoint to go on from
  /// What the user asked for by name and the checkpoint's candidate is not, in words; empty if it is all of it.
  std::function<std::string(const Candidate&)> missing;
};

/// Fills in the answer's candidate, outcome, times and `until`. Goes on from the checkpoint, with its candidate, if it is to resume; keeps
/// one, also when it is stopped. `answer` has the request. The job has its scene, if photons were traced in one. Ranks share the rays
/// that follow the job's own.
void run_to_target(RunAnswer& answer, const Job& job, const CandidateOfRun& candidate, const std::stop_token& stop,
                   const sim::ReportPhase& progress, sim::Ranks* ranks);

}  // namespace detp::validate
