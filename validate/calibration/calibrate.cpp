#include "calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "built_in_costs.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/validate/measure/rounds.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "timed_workloads.hpp"

namespace detp::validate {
namespace {

constexpr double longest_run = 0.012;     ///< seconds; a longer run is stopped and left out
constexpr double longest_of_large = 0.2;  ///< the same with many discs or many rays
constexpr double share_of_first = 0.5;    ///< of the time, for the first round over the workloads
constexpr int further_rounds = 7;
constexpr double long_run = 0.006;  ///< seconds; a shorter run is repeated once in a round, to find warm caches
constexpr std::size_t least_on_one_thread = 10;  ///< runs for a fit
constexpr std::size_t least_on_more = 5;

class Calibrator {
 public:
  explicit Calibrator(const CalibrationOptions& options)
      : options_(options), numbers_(thread_numbers(sim::thread_count(options.threads))) {}

  MeasuredCalibration run() && {
    const std::vector<TimedWorkload> all = timed_workloads();
    const auto more = [&](std::size_t i) {
      return i < least_workloads || watch_.seconds() < share_of_first * options_.seconds;
    };
    for (std::size_t i = 0; i < all.size() && more(i) && !options_.stop.stop_requested(); ++i) {
      report();
      add(all[i], i);
    }
    in_turns(timed_.size(), further_rounds, [&](std::size_t i, int round) {
      if (is_over(round)) return false;
      report();
      if (!agrees(timed_[i])) time(timed_[i]);
      return true;
    });
    result_.workloads = scenes_.size();
    result_.stopped = options_.stop.stop_requested();
    if (wall_seconds_ > 0) result_.processor_share = processor_seconds_ / wall_seconds_;
    const double usual = usual_over_shortest();
    for (const TimedCandidate& one : timed_) store(one, usual);
    fit_all();
    set_touch_cost(result_);
    for (CostFit& one : result_.fits) one.costs.touch = result_.of(one.engine)[one.technique].touch;
    result_.seconds = watch_.seconds();
    return std::move(result_);
  }

 private:
  /// The runs of one technique by one engine.
  struct TechniqueRuns {
    std::vector<TimedRun> on_one_thread;
    std::vector<ThreadedRun> on_more;
  };

  [[nodiscard]] TechniqueRuns& runs_of(Engine engine, Technique technique) {
    return runs_[static_cast<std::size_t>(engine)][static_cast<std::size_t>(technique)];
  }

  [[nodiscard]] static bool agrees(const TimedCandidate& timed) {
    constexpr std::size_t enough = 3;  // rounds, for a median
    return std::ranges::all_of(timed.times,
                               [](const RoundTimes& one) { return one.rounds() >= enough && one.agree(); });
  }

  /// Not before the first further round, which tells whether a time was disturbed.
  [[nodiscard]] bool is_over(int round) const {
    return options_.stop.stop_requested() || (round > 0 && watch_.seconds() >= options_.seconds);
  }

  void report() const {
    if (!options_.progress) return;
    const double seconds = watch_.seconds();
    options_.progress({fmt::format("{} workloads", scenes_.size()), std::min(1.0, seconds / options_.seconds), 1, 0,
                       options_.seconds - seconds});
  }

  /// Makes a workload, and times its candidates once.
  void add(const TimedWorkload& workload, std::size_t place) {
    const TimedScene& scene = scenes_.emplace_back(workload, place);
    for (const Candidate& candidate : timed_candidates(workload, place))
      for (const Engine engine : {Engine::simd, Engine::plain}) {
        if (options_.stop.stop_requested()) return;
        if (engine == Engine::plain && (!record_of(candidate.technique).simd || is_large(workload))) continue;
        if (!is_hopeless(workload, candidate.technique, engine)) count(scene, workload, candidate, engine);
      }
  }

  /// Counts the candidate's operations, and times it, unless it takes too long.
  void count(const TimedScene& scene, const TimedWorkload& workload, const Candidate& candidate, Engine engine) {
    const double longest = is_large(workload) ? longest_of_large : longest_run;
    const StopAfter limit(options_.stop, longest);
    const sim::Outcome counted = sim::run(scene.problem, candidate, {.engine = engine, .stop = limit.token()});
    if (counted.stopped) too_long_.push_back({candidate.technique, engine, workload});
    if (counted.stopped || counted.seconds.total() > longest) return;
    TimedCandidate one{&scene, candidate, engine, as_expected(counted.counts)};
    if (engine == Engine::simd && scene.place % 2 == 0 && is_divided(one.counts, candidate.technique, engine))
      one.threads = numbers_;
    one.times.resize(one.threads.size());
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
  void time(TimedCandidate& one) {
    for (RoundTimes& times : one.times) times.begin_round();
    double timed = 0;
    for (int i = 0; i < 2 && timed < long_run; ++i) {
      for (std::size_t j = 0; j < one.threads.size(); ++j) {
        const RunTime run =
            time_run(one.scene->problem, one.candidate,
                     {.count = false, .engine = one.engine, .stop = options_.stop, .threads = one.threads[j]});
        if (run.outcome.stopped) return;
        one.times[j].add(run.seconds, run.preparing);
        if (j > 0) continue;
        const double wall = run.outcome.seconds.total();
        timed += wall;
        wall_seconds_ += wall;
        processor_seconds_ += run.seconds;
      }
    }
  }

  /// Users wait what is usual, not the shortest time. Much more than that is other programs' doing.
  [[nodiscard]] double usual_over_shortest() const {
    constexpr double most = 1.1;
    std::vector<double> ratios;
    for (const TimedCandidate& one : timed_)
      if (const RoundTimes& times = one.times.front(); times.timed())
        ratios.push_back(times.usual_seconds() / times.seconds());
    return ratios.empty() ? 1 : std::min(most, median(std::move(ratios)));
  }

  void store(const TimedCandidate& timed, double usual) {
    const RoundTimes& one = timed.times.front();
    const TimedScene& scene = *timed.scene;
    if (!one.timed()) return;
    TechniqueRuns& runs = runs_of(timed.engine, timed.candidate.technique);
    runs.on_one_thread.push_back({scene.place, timed.counts,
                                  usual * one.seconds() + scene.checking_discs + scene.checking_rays,
                                  usual * one.preparing() + scene.checking_discs});
    for (std::size_t i = 1; i < timed.threads.size(); ++i)
      if (const RoundTimes& more = timed.times[i]; more.timed() && more.agree())
        runs.on_more.push_back({scene.place, timed.counts, timed.threads[i], one.seconds(), one.preparing(),
                                more.seconds(), more.preparing()});
  }

  /// Sets the costs, their fits and errors. Techniques with too few runs get the built-in costs, and the error of all.
  void fit_all() {
    for (const Engine engine : {Engine::simd, Engine::plain}) {
      result_.of(engine) = built_in_unit_costs(engine);
      for (const Technique technique : all_techniques) fit(technique, engine);
    }
    for (const Technique technique : all_techniques)
      if (!record_of(technique).simd) {  // both engines are the same
        result_.plain[technique] = result_.simd[technique];
        result_.plain.threads_of(technique) = result_.simd.threads_of(technique);
      }
    for (const Engine engine : {Engine::plain, Engine::simd})  // always plain
      result_.of(engine)[Technique::sphere_cache_published] = result_.plain[Technique::sphere_cache];
    result_.left_out_median_error = median_error_of(result_.fits);
    result_.threads_left_out_median_error = median_error_of(result_.thread_fits);
    set_relative_errors();
  }

  void fit(Technique technique, Engine engine) {
    CostTable& costs = result_.of(engine);
    const TechniqueRuns& runs = runs_of(engine, technique);
    if (runs.on_one_thread.size() >= least_on_one_thread) {
      result_.fits.push_back(fit_costs(runs.on_one_thread, technique, costs[technique], engine));
      costs[technique] = result_.fits.back().costs;
    }
    if (runs.on_more.size() < least_on_more) return;
    const ThreadFit threads = fit_threads(runs.on_more, technique, engine, costs.threads_of(technique));
    if (threads.left_out_errors.empty()) return;  // too few workloads
    result_.thread_fits.push_back(threads);
    costs.threads_of(technique) = threads.costs;
  }

  /// Of all left-out runs; 0 without any.
  template <class Fit>
  static double median_error_of(const std::vector<Fit>& fits) {
    std::vector<double> all;
    for (const Fit& fit : fits) all.insert(all.end(), fit.left_out_errors.begin(), fit.left_out_errors.end());
    return all.empty() ? 0 : median(std::move(all));
  }

  void set_relative_errors() {
    const double of_all = CalibrationQuality{result_.left_out_median_error, result_.processor_share}.relative_error();
    for (const Engine engine : {Engine::plain, Engine::simd}) result_.of(engine).relative_errors.fill(of_all);
    for (const CostFit& fit : result_.fits) {
      if (fit.left_out_errors.empty()) continue;
      const CalibrationQuality quality{fit.left_out_median_error(), result_.processor_share};
      for (const Engine engine : {Engine::plain, Engine::simd})
        if (engine == fit.engine || !record_of(fit.technique).simd)
          result_.of(engine).relative_error_of(fit.technique) = quality.relative_error();
    }
  }

  struct TooLong {
    Technique technique;
    Engine engine;
    TimedWorkload workload;
  };

  const CalibrationOptions& options_;
  std::vector<int> numbers_;  ///< of threads
  sim::Stopwatch watch_;
  MeasuredCalibration result_;
  std::deque<TimedScene> scenes_;
  std::vector<TimedCandidate> timed_;
  std::array<std::array<TechniqueRuns, technique_records.size()>, 2> runs_;  ///< by engine
  double wall_seconds_ = 0;                                                  ///< of runs on one thread
  double processor_seconds_ = 0;                                             ///< of these
  std::vector<TooLong> too_long_;
};

}  // namespace

MeasuredCalibration calibrate(const CalibrationOptions& options) {
  const sim::DefaultFloatingPoint mode;
  return Calibrator(options).run();
}

}  // namespace detp::validate
