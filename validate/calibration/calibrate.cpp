#include "calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "built_in_costs.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/measure/in_turns.hpp"
#include "detp/validate/measure/stop_after.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "fit_all.hpp"
#include "timed_workloads.hpp"

namespace detp::validate {
namespace {

constexpr double longest_run = 0.012;     ///< seconds; a longer run is stopped and left out
constexpr double longest_of_large = 0.2;  ///< the same with many discs or many rays
constexpr double share_of_first = 0.5;    ///< of the time, for the first round over the workloads
constexpr int further_rounds = 7;
constexpr double long_run = 0.006;  ///< seconds; a shorter run is repeated once in a round, to find warm caches

class Calibrator {
 public:
  explicit Calibrator(const CalibrationOptions& options)
      : options_(options), numbers_(thread_numbers(sim::thread_count(options.threads))) {}

  Calibration run() && {
    const std::vector<TimedWorkload> all = timed_workloads();
    const auto more = [&](std::size_t i) {
      return i < least_workloads || watch_.seconds() < share_of_first * options_.seconds;
    };
    for (std::size_t i = 0; i < all.size() && more(i) && !options_.stop.stop_requested(); ++i) {
      report();
      add(all[i], i);
    }
    const auto begin = [](int) { return true; };
    in_turns(timed_.size(), further_rounds, begin, [&](std::size_t i, int round) {
      if (is_over(round)) return false;
      report();
      if (!timed_[i].agrees()) time(timed_[i]);
      return true;
    });
    result_.workloads = workloads_.size();
    result_.stopped = options_.stop.stop_requested();
    if (wall_seconds_ > 0) result_.processor_share = processor_seconds_ / wall_seconds_;
    const double usual = usual_over_shortest();
    for (const Timed& one : timed_) store(one, usual);
    fit_all(runs_, result_);
    set_touch_cost(result_);
    result_.seconds = watch_.seconds();
    return std::move(result_);
  }

 private:
  struct Workload {
    std::size_t place;
    std::vector<sim::Disc> discs;
    std::vector<sim::Ray> rays;
    sim::Problem problem = sim::make_problem(rays, discs);  // borrows both
    CheckSeconds checks = time_checks(problem, rays, discs);
  };

  /// A candidate of a workload, and its times so far on each number of threads.
  struct Timed {
    const Workload* workload;
    Candidate candidate;
    Engine engine;
    Counts<double> counts;
    std::vector<int> numbers = {1};
    std::vector<RoundTimes> times = {};

    [[nodiscard]] bool agrees() const {
      constexpr std::size_t enough = 3;  // rounds, for a median
      return std::all_of(times.begin(), times.end(),
                         [](const RoundTimes& one) { return one.rounds() >= enough && one.agree(); });
    }
  };

  /// Not before the first further round, which tells whether a time was disturbed.
  [[nodiscard]] bool is_over(int round) const {
    return options_.stop.stop_requested() || (round > 0 && watch_.seconds() >= options_.seconds);
  }

  void report() const {
    if (!options_.progress) return;
    const double seconds = watch_.seconds();
    options_.progress({fmt::format("{} workloads", workloads_.size()), std::min(1.0, seconds / options_.seconds), 1, 0,
                       options_.seconds - seconds});
  }

  /// Makes a workload, and times its candidates once.
  void add(const TimedWorkload& workload, std::size_t place) {
    std::vector<sim::Disc> discs = discs_of(workload, place);
    std::vector<sim::Ray> rays = rays_of(workload, discs, place);
    const auto& made = workloads_.emplace_back(new Workload{place, std::move(discs), std::move(rays)});
    for (const Candidate& candidate : timed_candidates(workload, place))
      for (const Engine engine : {Engine::simd, Engine::plain}) {
        if (options_.stop.stop_requested()) return;
        if (engine == Engine::plain && (!record_of(candidate.technique).simd || is_large(workload))) continue;
        if (!is_hopeless(workload, candidate.technique, engine)) count(*made, workload, candidate, engine);
      }
  }

  /// Counts the candidate's operations, and times it, unless it takes too long.
  void count(const Workload& made, const TimedWorkload& workload, const Candidate& candidate, Engine engine) {
    const double longest = is_large(workload) ? longest_of_large : longest_run;
    const StopAfter limit(options_.stop, longest);
    const sim::Outcome counted = sim::run(made.problem, candidate, {.engine = engine, .stop = limit.token()});
    if (counted.stopped) too_long_.push_back({candidate.technique, engine, workload});
    if (counted.stopped || counted.seconds.total() > longest) return;
    Timed one{&made, candidate, engine, as_expected(counted.counts)};
    if (engine == Engine::simd && made.place % 2 == 0 && is_divided(one.counts, candidate.technique, engine))
      one.numbers = numbers_;
    one.times.resize(one.numbers.size());
    time(timed_.emplace_back(std::move(one)));
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
  void time(Timed& one) {
    for (RoundTimes& times : one.times) times.begin_round();
    double timed = 0;
    for (int i = 0; i < 2 && timed < long_run; ++i) {
      for (std::size_t j = 0; j < one.numbers.size(); ++j) {
        const sim::ProcessorStopwatch processor;
        const sim::Outcome outcome =
            sim::run(one.workload->problem, one.candidate,
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

  /// Users wait what is usual, not the shortest time. Much more than that is other programs' doing.
  [[nodiscard]] double usual_over_shortest() const {
    constexpr double most = 1.1;
    std::vector<double> ratios;
    for (const Timed& one : timed_)
      if (one.times.front().timed()) ratios.push_back(one.times.front().usual_over_shortest());
    return ratios.empty() ? 1 : std::min(most, median(std::move(ratios)));
  }

  void store(const Timed& timed, double usual) {
    const RoundTimes& one = timed.times.front();
    const std::size_t place = timed.workload->place;
    const CheckSeconds& checks = timed.workload->checks;
    if (!one.timed()) return;
    TechniqueRuns& runs = runs_.of(timed.engine, timed.candidate.technique);
    runs.on_one_thread.push_back({place, timed.counts, usual * one.seconds() + checks.discs + checks.rays,
                                  usual * one.preparing() + checks.discs});
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
  std::vector<std::unique_ptr<const Workload>> workloads_;
  std::vector<Timed> timed_;
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
