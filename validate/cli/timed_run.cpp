#include "timed_run.hpp"

#include <algorithm>

#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/streamed.hpp"

namespace detp::cli {

TimedRun run_job(const validate::Job& job, const Candidate& candidate, const sim::RunOptions& options,
                 const ProgressLine& progress) {
  const auto show = [&](double done) { progress.show(name(candidate.technique), done); };
  show(0);
  if (job.stream) {
    sim::Streamed streamed = sim::run_streamed(job.discs, *job.stream, candidate,
                                               {.run = options, .front_facing = job.front_facing, .progress = show});
    return {std::move(streamed.outcome), streamed.check_seconds, streamed.read_seconds, streamed.block};
  }
  const sim::Stopwatch watch;
  const sim::Problem problem = job.problem(options.threads, options.stop);
  const double prepare = watch.seconds();
  return {sim::run(problem, candidate, options), prepare, 0, job.rays.size()};
}

Timing time_runs(const validate::Job& job, const Candidate& candidate, const TimedRun& counted, int repeat,
                 const sim::RunOptions& options, const ProgressLine& progress) {
  std::vector<Timing> timings;
  for (int i = 0; i < repeat; ++i) {
    const TimedRun run = run_job(job, candidate, options, progress);
    if (run.outcome.stopped) break;
    timings.push_back({run.outcome.seconds, run.prepare_seconds, {}});
  }
  if (timings.empty()) timings.push_back({counted.outcome.seconds, counted.prepare_seconds, {}});
  std::vector<double> all;
  for (const Timing& timing : timings) all.push_back(timing.total());
  std::sort(timings.begin(), timings.end(), [](const Timing& a, const Timing& b) { return a.total() < b.total(); });
  Timing median = timings[timings.size() / 2];
  median.all = std::move(all);
  return median;
}

}  // namespace detp::cli
