#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/technique.hpp"

/// The time of one run.
namespace detp::validate {

/// Measures how long a run takes apart from what other programs take: on one thread, the seconds of the processor or of the
/// wall clock, whichever are fewer; on several threads, of the wall clock.
class OwnTime {
 public:
  explicit OwnTime(int threads) : one_thread_(threads == 1) {}

  [[nodiscard]] double seconds() const { return own_part_of(wall_.seconds()); }

  /// `wall` are the seconds of the whole run, or of a part of it, by the wall clock.
  [[nodiscard]] double own_part_of(double wall) const {
    return one_thread_ ? std::min(wall, processor_.seconds()) : wall;
  }

 private:
  bool one_thread_;
  sim::Stopwatch wall_;
  sim::ProcessorStopwatch processor_;
};

/// A run of a candidate, and its seconds (OwnTime): sorting, building and searching.
struct RunTime {
  sim::Outcome outcome;
  double seconds = 0;    ///< if a stop request ended the run, until then
  double preparing = 0;  ///< of these, for sorting and building
};

[[nodiscard]] inline RunTime time_run(const sim::Problem& problem, const Candidate& candidate,
                                      const sim::RunOptions& how) {
  const OwnTime time(how.threads);
  RunTime run{.outcome = sim::run(problem, candidate, how)};
  const auto& seconds = run.outcome.seconds;
  run.seconds = run.outcome.stopped ? time.seconds() : time.own_part_of(seconds.total());
  run.preparing = std::min(run.seconds, seconds.order + seconds.build);
  return run;
}

/// Requests a stop after `seconds`, or as soon as a stop is requested through `other`.
class StopAfter {
 public:
  StopAfter(const std::stop_token& other, double seconds)
      : on_other_(other, Request{stop_}), clock_([stop = stop_, seconds](const std::stop_token& end) mutable {
          std::mutex mutex;
          std::condition_variable_any never;
          std::unique_lock lock(mutex);
          never.wait_for(lock, end, std::chrono::duration<double>(seconds), [] { return false; });
          if (!end.stop_requested()) stop.request_stop();
        }) {}

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  struct Request {
    std::stop_source stop;
    void operator()() { stop.request_stop(); }
  };

  std::stop_source stop_;
  std::stop_callback<Request> on_other_;
  std::jthread clock_;
};

}  // namespace detp::validate
