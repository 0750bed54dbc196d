#include "technique.hpp"

#include <algorithm>

#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "registry.hpp"

namespace detp::sim {

Outcome run(const Problem& problem, const Valid<Candidate>& candidate, const RunOptions& options) {
  check_options(options, problem);
  Stopwatch watch;
  std::unique_ptr<Index> index;
  try {
    StopCheck(options.stop, "beginning").now();
    index = prepare(problem, candidate, options);
  } catch (const Stopped&) {
    Outcome outcome = unsearched_outcome(problem, options);
    outcome.seconds.build = watch.lap();
    return outcome;
  }
  return run(problem, *index, options);
}

Outcome run(const Problem& problem, const Index& index, const RunOptions& options) {
  Outcome outcome = search(index, problem, options);
  const Built& built = index.built();
  outcome.seconds.order += built.seconds.order;
  outcome.seconds.build += built.seconds.build;
  outcome.bytes = std::max(outcome.bytes, built.bytes);
  if (options.count) outcome.counts += built.counts;
  return outcome;
}

}  // namespace detp::sim
