#include "technique.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/sim/stop_check.hpp"
#include "detp/sim/stopwatch.hpp"
#include "detp/sim/threads.hpp"
#include "index.hpp"

namespace detp::sim {
namespace {

void check_options(const RunOptions& options, const Problem& problem) {
  if (problem.discs.empty() || !(problem.slack > 0 && problem.slack < unbounded))
    throw std::invalid_argument("a problem needs discs and a slack > 0; make it by make_problem");
  require_count("number of threads", options.threads, 0, most_threads);
  if (options.totals != nullptr && !options.totals->empty() && options.totals->size() != problem.discs.size())
    throw std::invalid_argument(fmt::format("totals of {} discs cannot go on with {}; give those of the same discs",
                                            options.totals->size(), problem.discs.size()));
}

/// The outcome of a run that was stopped before it searched.
Outcome nothing(const Problem& problem, const RunOptions& options) {
  Outcome outcome;
  outcome.stopped = true;
  outcome.progress.of = problem.rays.size();
  if (options.totals == nullptr) finish(Totals(problem.discs.size()), problem.discs, outcome);
  return outcome;
}

}  // namespace

void finish(const Totals& totals, std::span<const Disc> discs, Outcome& outcome) {
  outcome.hits.resize(discs.size());
  outcome.irradiance.resize(discs.size());
  for (std::size_t disc = 0; disc < discs.size(); ++disc) {
    outcome.hits[disc] = totals[disc].hits;
    outcome.irradiance[disc] = irradiance(totals[disc], discs[disc]);
  }
}

void keep_done_discs(Outcome& outcome) {
  outcome.progress = {0, outcome.done_discs.size(), "discs"};
  outcome.total_hits = 0;
  for (std::size_t disc = 0; disc < outcome.done_discs.size(); ++disc) {
    if (!outcome.done_discs[disc]) outcome.hits[disc] = 0;
    if (!outcome.done_discs[disc]) outcome.irradiance[disc] = 0;
    outcome.progress.done += outcome.done_discs[disc] ? 1 : 0;
    outcome.total_hits += outcome.hits[disc];
  }
  outcome.counts.hits = outcome.total_hits;
}

Outcome search(const Index& index, const Problem& problem, const RunOptions& options) {
  check_options(options, problem);
  Outcome outcome;
  Stopwatch watch;
  try {
    StopCheck(options.stop, "beginning").now();
    index.search(problem, options, outcome);
  } catch (const Stopped&) {  // before the search
    const double bytes = outcome.bytes;
    outcome = nothing(problem, options);
    outcome.bytes = bytes;
  }
  outcome.seconds.search = watch.lap() - outcome.seconds.build;
  return outcome;
}

Outcome run(const Problem& problem, const Candidate& candidate, const RunOptions& options) {
  check(candidate);
  check_options(options, problem);
  Stopwatch watch;
  std::unique_ptr<Index> index;
  try {
    StopCheck(options.stop, "beginning").now();
    index = prepare(problem, candidate, options);
  } catch (const Stopped&) {
    Outcome outcome = nothing(problem, options);
    outcome.seconds.build = watch.lap();
    return outcome;
  }
  Outcome outcome = search(*index, problem, options);
  const Built& built = index->built();
  outcome.seconds.order += built.seconds.order;
  outcome.seconds.build += built.seconds.build;
  outcome.bytes = std::max(outcome.bytes, built.bytes);
  if (options.count) outcome.counts += built.counts;
  return outcome;
}

}  // namespace detp::sim
