#include "calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "built_in_costs.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/in_turns.hpp"
#include "detp/validate/base/stop_after.hpp"
#include "fit_all.hpp"
#include "round_times.hpp"
#include "timed_workloads.hpp"

namespace detp::validate {
namespace {

constexpr double longest_run = 0.06;      ///< seconds; a longer run is stopped and left out
constexpr double longest_of_large = 0.3;  ///< the same with many discs or many rays
constexpr int rounds_of_workload = 6;
constexpr int most_repeats = 4;            ///< in a round
constexpr double enough_in_round = 0.005;  ///< seconds after which a run is not repeated in the same round
constexpr double long_run = 0.03;          ///< seconds; a shorter run is repeated once at least, to find warm caches

class Calibrator {
 public:
  explicit Calibrator(const CalibrationOptions& options)
      : options_(options), numbers_(thread_numbers(sim::thread_count(options.threads))) {}

  Calibration run() && {
    const std::vector<TimedWorkload> all = timed_workloads();
    for (std::size_t i = 0; i < all.size() && !is_over(i); ++i) {
      report(watch_.seconds());
      measure(all[i], i);
      ++result_.workloads;
    }
    result_.stopped = options_.stop.stop_requested();
    if (wall_seconds_ > 0) result_.processor_share = processor_seconds_ / wall_seconds_;
    fit_all(runs_, result_);
    result_.seconds = watch_.seconds();
    return std::move(result_);
  }

 private:
  /// A candidate of a workload, and its times so far on each number of threads.
  struct Timed {
    Candidate candidate;
    Engine engine;
    Counts<double> counts;
    std::vector<int> numbers = {1};
    std::vector<RoundTimes> times = {};

    [[nodiscard]] bool agrees() const {
      return std::all_of(times.begin(), times.end(), [](const RoundTimes& one) { return one.agree(); });
    }
  };

  [[nodiscard]] bool is_over(std::size_t place) const {
    return options_.stop.stop_requested() || (place >= least_workloads && watch_.seconds() >= options_.seconds);
  }

  void report(double seconds) const {
    if (!options_.progress) return;
    const double share = std::min(1.0, seconds / options_.seconds);
    options_.progress({fmt::format("workload {}", result_.workloads + 1), share, 1, 0, options_.seconds - seconds});
  }

  void measure(const TimedWorkload& workload, std::size_t place) {
    const auto discs = discs_of(workload, place);
    const auto rays = rays_of(workload, discs, place);
    const sim::Problem problem = sim::make_problem(rays, discs);
    std::vector<Timed> all;
    for (const Candidate& candidate : timed_candidates(workload, place))
      for (const Engine engine : {Engine::simd, Engine::plain})
        if ((engine == Engine::simd || record_of(candidate.technique).simd) && !is_over(place) &&
            !is_hopeless(workload, candidate.technique, engine))
          count(problem, workload, candidate, engine, place, all);
    const auto begin = [&](int) {
      return !std::all_of(all.begin(), all.end(), [](auto& one) { return one.agrees(); });
    };
    in_turns(all.size(), rounds_of_workload, begin, [&](std::size_t i, int) {
      if (is_over(place)) return false;
      if (!all[i].agrees()) time(problem, all[i]);
      return true;
    });
    for (const Timed& one : all) store(one, place);
  }

  /// Counts the candidate's operations, and adds it to those to time, unless it takes too long.
  void count(const sim::Problem& problem, const TimedWorkload& workload, const Candidate& candidate, Engine engine,
             std::size_t place, std::vector<Timed>& all) {
    const double longest = is_large(workload) ? longest_of_large : longest_run;
    const StopAfter limit(options_.stop, longest);
    const sim::Outcome counted = sim::run(problem, candidate, {.engine = engine, .stop = limit.token()});
    if (counted.stopped) too_long_.push_back({candidate.technique, engine, workload});
    if (counted.stopped || counted.seconds.total() > longest) return;
    Timed one{candidate, engine, as_expected(counted.counts)};
    if (place % 2 == 0 && is_divided(one.counts, candidate.technique, engine)) one.numbers = numbers_;
    one.times.resize(one.numbers.size());
    all.push_back(std::move(one));
  }

  /// Whether two threads would be busy.
  [[nodiscard]] static bool is_divided(const Counts<double>& counts, Technique technique, Engine engine) {
    const Pieces pieces = pieces_of(counts, technique, engine);
    return busy_threads(pieces.preparing, 2) > 1 || busy_threads(pieces.search, 2) > 1;
  }

  /// Whether the technique took too long with fewer rays and discs.
  [[nodiscard]] bool is_hopeless(const TimedWorkload& workload, Technique technique, Engine engine) const {
    return std::any_of(too_long_.begin(), too_long_.end(), [&](const TooLong& one) {
      return one.technique == technique && one.engine == engine && one.workload.samples <= workload.samples &&
             one.workload.rays <= workload.rays;
    });
  }

  /// One round of runs of the candidate, which alternate between the numbers of threads.
  void time(const sim::Problem& problem, Timed& one) {
    for (RoundTimes& times : one.times) times.begin_round();
    double timed = 0;
    for (int i = 0; i < most_repeats && timed < (i < 2 ? long_run : enough_in_round); ++i) {
      for (std::size_t j = 0; j < one.numbers.size(); ++j) {
        const sim::ProcessorStopwatch processor;
        const sim::Outcome outcome =
            sim::run(problem, one.candidate,
                     {.count = false, .engine = one.engine, .stop = options_.stop, .threads = one.numbers[j]});
        if (outcome.stopped) return;
        const double wall = outcome.seconds.total();
        const double preparing = outcome.seconds.order + outcome.seconds.build;
        if (j > 0) {
          one.times[j].add(wall, preparing);
          continue;
        }
        const double own = std::min(processor.seconds(), wall);  // without the time that other programs took
        one.times[j].add(own, std::min(preparing, own));
        timed += wall;
        wall_seconds_ += wall;
        processor_seconds_ += own;
      }
    }
  }

  void store(const Timed& timed, std::size_t place) {
    const RoundTimes& one = timed.times.front();
    if (!one.timed()) return;
    TechniqueRuns& runs = runs_.of(timed.engine, timed.candidate.technique);
    runs.on_one_thread.push_back({place, timed.counts, one.seconds(), one.preparing()});
    for (std::size_t i = 1; i < timed.numbers.size(); ++i)
      if (const RoundTimes& more = timed.times[i]; more.timed() && more.agree())
        runs.on_more.push_back(
            {place, timed.counts, timed.numbers[i], one.seconds(), one.preparing(), more.seconds(), more.preparing()});
  }

  struct TooLong {
    Technique technique;
    Engine engine;
    TimedWorkload workload;
  };

  const CalibrationOptions& options_;
  std::vector<int> numbers_;  ///< of threads
  sim::Stopwatch watch_;
  Calibration result_;
  TimedRuns runs_;
  double wall_seconds_ = 0;       ///< of runs on one thread
  double processor_seconds_ = 0;  ///< of these
  std::vector<TooLong> too_long_;
};

}  // namespace

Calibration calibrate(const CalibrationOptions& options) {
  const sim::DefaultFloatingPoint mode;
  return Calibrator(options).run();
}

}  // namespace detp::validate
