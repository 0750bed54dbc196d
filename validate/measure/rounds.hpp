#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/technique/technique.hpp"

/// Times contenders in turns, and single runs.
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

/// Calls run(i, round) for each contender i in each round; ends as soon as it returns false. Because contenders take turns, a
/// disturbance of the machine affects all of them alike. Each round after the first has another order, so that none of them
/// always finds the caches as the same other one left them.
template <class Run>
void in_turns(std::size_t contenders, int rounds, const Run& run) {
  std::vector<std::size_t> order(contenders);
  std::iota(order.begin(), order.end(), 0U);
  std::minstd_rand random;
  for (int round = 0; round < rounds; ++round) {
    for (const std::size_t i : order)
      if (!run(i, round)) return;
    std::shuffle(order.begin(), order.end(), random);
  }
}

/// Seconds of each contender, one for each round in which it took part.
using TimesOfAll = std::vector<std::vector<double>>;

struct RoundLimits {
  int rounds = 5;           ///< at most
  int rounds_of_all = 4;    ///< in which all contenders take part
  int least_rounds = 1;     ///< that begin whatever time they take
  double most_seconds = 3;  ///< no further round begins after this time
};

/// The times of each contender. After the rounds of all, those take part for which `goes_on` is true, by the times so far. Times of
/// other runs decide nothing: the speed of the machine may have changed since.
///
/// Two contenders are compared by median_ratio() of their times. Runs of one round follow each other closely, so a change
/// of the machine's speed from round to round cancels. The shortest times need not be times of the same speed.
///
/// `time` returns the seconds of one run of a contender, whose times so far it gets, or nullopt to end the rounds.
[[nodiscard]] TimesOfAll timed_rounds(
    std::size_t contenders, const RoundLimits& limits,
    const std::function<std::vector<bool>(const TimesOfAll&)>& goes_on,
    const std::function<std::optional<double>(std::size_t, std::span<const double>)>& time);

/// Whose shortest time is at most `factor` times the shortest of all.
[[nodiscard]] std::vector<bool> not_behind(const TimesOfAll& times, double factor);

/// The times of one contender whose runs have two phases. The runs of a round follow each other, so that the data are in the
/// caches; their shortest time counts. Between two rounds other contenders run, so that a disturbance by other programs rarely
/// lasts for both.
class RoundTimes {
 public:
  void begin_round() {
    seconds_.push_back(unknown);
    preparing_.push_back(unknown);
  }

  void add(double seconds, double preparing) {
    seconds_.back() = std::min(seconds_.back(), seconds);
    preparing_.back() = std::min(preparing_.back(), preparing);
  }

  [[nodiscard]] std::size_t rounds() const { return seconds_.size(); }
  [[nodiscard]] bool timed() const { return !seconds_.empty() && seconds() > 0 && seconds() < unknown; }

  /// Whether the shortest times of two rounds agree. A time that only one round reached may be a stroke of luck, such as a
  /// processor that was faster for a moment; much longer times were disturbed.
  [[nodiscard]] bool agree() const;

  /// The shortest of all rounds.
  [[nodiscard]] double seconds() const { return std::ranges::min(seconds_); }
  [[nodiscard]] double preparing() const { return std::ranges::min(preparing_); }
  /// The middle one of the rounds, the lower of two.
  [[nodiscard]] double usual_seconds() const { return lower_median(seconds_); }
  [[nodiscard]] double usual_preparing() const { return lower_median(preparing_); }
  /// The same of what is left of each round's seconds without preparing.
  [[nodiscard]] double usual_search() const;

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  [[nodiscard]] static double lower_median(std::vector<double> values);

  std::vector<double> seconds_;  ///< the shortest of each round
  std::vector<double> preparing_;
};

}  // namespace detp::validate
