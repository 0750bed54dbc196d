#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/base/phase.hpp"
#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/ranked/ranked.hpp"
#include "detp/sim/ranks/ranks.hpp"
#include "detp/sim/reference/missed_light.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/choice/choice.hpp"
#include "detp/validate/job/job.hpp"

/// A run of a candidate on which all ranks agree, and its times.
namespace detp::validate {

/// A candidate, the number of threads of its run, and the choice if it came by one.
struct RunCandidate {
  Candidate candidate = {};
  int threads = 1;
  std::optional<Choice> choice = {};
};

/// What rank 0 has chosen, on all ranks, of which others have no choice; `ranks` null: on this process alone.
[[nodiscard]] RunCandidate agreed(sim::Ranks* ranks, const std::function<RunCandidate()>& of_first);

/// A run over all rays of a job. The rays are in memory or a stream.
struct JobRun {
  sim::Outcome outcome;
  double prepare_seconds = 0;             ///< time for checking rays and discs, and for S₀
  double trace_seconds = 0;               ///< time for making the rays of a stream
  std::size_t rays_in_memory = 0;         ///< maximum number of rays in memory at a time
  std::vector<double> rank_seconds = {};  ///< of each rank (sim::RankedOutcome); empty if one process searched
  sim::Share share = sim::Share::rays;    ///< among ranks
  /// hits, irradiance and pairs, which the outcome lacks, if the discs are not in memory; null on other ranks
  std::shared_ptr<const sim::PartResults> results = {};
  sim::MissedShare missed = {};  ///< of gather: the light that it misses; finding it is part of prepare_seconds
};

[[nodiscard]] inline std::uint64_t disc_count(const JobRun& run) {
  return run.results ? run.results->discs() : run.outcome.hits.size();
}
/// Calls visit(std::span<const sim::DiscResult> by_band) for all discs, in their order.
template <class Visit>
void for_each_disc(const JobRun& run, const Visit& visit) {
  if (run.results) return run.results->for_each_disc(visit);
  const sim::Outcome& found = run.outcome;
  std::vector<sim::DiscResult> by_band(found.bands());
  for (std::size_t disc = 0; disc < found.hits.size(); ++disc) {
    for (std::size_t band = 0; band < by_band.size(); ++band) by_band[band] = sim::result_of(found, disc, band);
    visit(std::span<const sim::DiscResult>(by_band));
  }
}

/// The processes that search together.
struct Together {
  sim::Ranks* ranks = nullptr;           ///< null: this one alone
  std::optional<sim::Share> share = {};  ///< default: usual_share
};

/// Runs the estimator; the rays of a stream by its technique, which finds pairs. Ranks share the rays of a stream, or the discs; on all but rank 0 the
/// outcome is that of run_on_ranks there. Gather also finds how much light it misses. Other searches do not know of ranks. `choice`: by a pilot, whose sorted
/// discs are used; null: none.
[[nodiscard]] JobRun run_job(const Job& job, const sim::EstimateRequest& request, const sim::RunOptions& options,
                             const sim::ReportPhase& progress, const Together& together = {}, Choice* choice = nullptr);

/// Times from discs and rays in memory to irradiance in memory, in seconds.
struct Timing {
  sim::Phases phases;
  double prepare = 0;
  std::vector<double> all;  ///< total time of each timed run

  [[nodiscard]] double total() const { return prepare + phases.total(); }
};

/// Times `repeat` runs without counting; if `repeat` is 0, or a stop request ended the first of them, returns the times
/// of the counting run. The phases returned are those of the run with the median time, or for an even number of runs,
/// of the slower of the two middle runs.
[[nodiscard]] Timing time_runs(const Job& job, const sim::EstimateRequest& request, const JobRun& counted, int repeat,
                               const sim::RunOptions& options, const sim::ReportPhase& progress,
                               const Together& together = {});

}  // namespace detp::validate
