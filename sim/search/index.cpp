#include "index.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "irradiance.hpp"

namespace detp::sim {

void check_options(const RunOptions& options, const Problem& problem) {
  require_count("number of threads", options.threads, 0, most_threads);
  if (options.standard_error && options.totals != nullptr)
    throw std::invalid_argument("with totals of the caller, standard errors are asked for by Totals::keep_errors");
  if (options.totals != nullptr && !options.totals->empty() && options.totals->size() != problem.discs().size())
    throw std::invalid_argument(
        fmt::format("totals of {} discs cannot be continued with {} discs; they must be of the same discs",
                    options.totals->size(), problem.discs().size()));
}

Outcome unsearched_outcome(const Problem& problem, const RunOptions& options) {
  Outcome outcome;
  outcome.stopped = true;
  outcome.progress.of = problem.rays().size();
  if (options.totals == nullptr) finish(Totals(problem.discs().size()), problem.discs(), outcome);
  return outcome;
}

Outcome search(const Index& index, const Problem& problem, const RunOptions& options) {
  Outcome outcome;
  search(index, problem, options, outcome);
  return outcome;
}

void search(const Index& index, const Problem& problem, const RunOptions& options, Outcome& outcome) {
  const DefaultFloatingPoint mode;
  check_options(options, problem);
  clear(outcome);
  Stopwatch watch;
  try {
    StopCheck(options.stop, "beginning").now();
    index.search(problem, options, outcome);
    if (options.progress && !outcome.stopped) options.progress(1);
    if (options.count) {
      outcome.counts.loaded = problem.rays().size();
      if (problem.segments()) outcome.counts.segments = outcome.counts.loaded;
    }
  } catch (const Stopped&) {  // stopped before the search
    const double bytes = outcome.bytes;
    outcome = unsearched_outcome(problem, options);
    outcome.bytes = bytes;
  }
  outcome.seconds.search = watch.lap() - outcome.seconds.build;
}

}  // namespace detp::sim
