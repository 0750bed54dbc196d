#include "calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "built_in_costs.hpp"
#include "detp/model/sphere_cache/sphere_count.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/geometry/lebesgue.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/scene/open/uniform_discs.hpp"
#include "detp/sim/technique/technique.hpp"
#include "detp/validate/base/stop_after.hpp"
#include "detp/validate/statistics/statistics.hpp"

namespace detp::validate {
namespace {

constexpr double side = 1;
constexpr double longest_run = 0.06;      ///< seconds; a longer run is stopped and left out
constexpr double longest_of_large = 0.2;  ///< the same with many discs or many rays
constexpr double enough_timed = 0.015;    ///< seconds after which a run is not repeated again
constexpr int least_repeats = 2;
constexpr int most_repeats = 7;

struct Setting {
  sim::Body body;
  std::size_t samples;
  std::size_t rays;
  double radius;
};

/// More discs, or more rays, than the last-level cache holds. Only techniques with short runs are timed on them.
constexpr std::size_t many = 200'000;
bool is_large(const Setting& setting) { return setting.samples > many || setting.rays > many; }

constexpr std::size_t least_workloads = 16;  ///< measured even if that takes longer than asked

/// The settings. First least_workloads small ones; then small and large, sparse and dense ones mixed, so that any first
/// part of them can be fitted.
std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const std::size_t samples : {100UL, 1000UL, 10'000UL, 100'000UL})
    for (const std::size_t rays : {100UL, 1000UL, 10'000UL, 100'000UL})
      for (const double spacing : {0.1, 0.5, 2.0})  // disc radius over the distance between samples
        for (const auto body : {sim::Body::cube, sim::Body::cube_faces}) {
          const double root = body == sim::Body::cube ? 1.0 / 3 : 0.5;
          const double distance = side / std::pow(static_cast<double>(samples), root);
          const double radius = std::min(0.2 * side, spacing * distance);
          if (static_cast<double>(samples * rays) * radius * radius < 3e6) all.push_back({body, samples, rays, radius});
        }
  std::vector<Setting> first;
  std::vector<Setting> mixed;
  constexpr std::size_t stride = 29;  // has no common factor with the number of settings
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Setting& one = all[i * stride % all.size()];
    const bool small = one.samples <= 1000 && one.rays <= 1000;
    (small && first.size() < least_workloads ? first : mixed).push_back(one);
  }
  const std::vector<Setting> large{
      {sim::Body::cube, 300'000, 100, 0.004},           {sim::Body::cube, 100, 1'000'000, 0.03},
      {sim::Body::cube_faces, 1'000'000, 1000, 0.0005}, {sim::Body::cube_faces, 1000, 300'000, 0.01},
      {sim::Body::cube_faces, 300'000, 10'000, 0.002},  {sim::Body::cube, 1000, 1'000'000, 0.01},
      {sim::Body::cube, 600'000, 100, 0.001},           {sim::Body::cube_faces, 10'000, 300'000, 0.01}};
  constexpr std::size_t apart = 2;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    if (i % apart == 0 && i / apart < large.size()) first.push_back(large[i / apart]);
    first.push_back(mixed[i]);
  }
  return first;
}

/// On every second pair of workloads, the discs follow each other along a curve, as the vertices of many meshes nearly do;
/// on the others, in random order.
std::vector<sim::Disc> discs_of(const Setting& setting, std::size_t place) {
  std::vector<sim::Disc> discs = sim::uniform_discs(setting.body, side, setting.samples, setting.radius, place + 1);
  if (place / 2 % 2 == 0) return discs;
  sim::Box box;
  for (const sim::Disc& disc : discs) box.include(disc.centre);
  std::sort(discs.begin(), discs.end(), [&](const sim::Disc& a, const sim::Disc& b) {
    return sim::lebesgue_code(a.centre, box) < sim::lebesgue_code(b.centre, box);
  });
  return discs;
}

/// Isotropic lines; on every second four workloads pieces of them, from 0.1 to 0.5 of the side long.
std::vector<sim::Ray> rays_of(const Setting& setting, const std::vector<sim::Disc>& discs, std::size_t place) {
  const sim::Sphere enclosing = sim::enclosing_sphere(discs);
  std::vector<sim::Ray> rays = sim::LineField(enclosing, place + 1).lines(0, setting.rays);
  if (place / 4 % 2 == 0) return rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto random = sim::uniform4(place + 1, sim::Stream::structure, i);
    rays[i].origin += (2 * random[0] - 1) * enclosing.radius * rays[i].direction;
    rays[i].length = (0.1 + 0.4 * random[1]) * side;
  }
  return rays;
}

/// Those whose runs are short even with many discs or many rays.
std::vector<Candidate> candidates_of_large(const Setting& setting, std::size_t place) {
  const int leaf = setting.rays > setting.samples ? 8 : place % 2 == 0 ? 64 : 256;
  return {{Technique::brute_force, BruteForceParameters{}},
          {Technique::box_tree, BoxTreeParameters{8, leaf}},
          {Technique::box_tree, BoxTreeParameters{16, 2 * leaf}}};
}

/// Parameters from too coarse to too fine; `place` varies them from setting to setting.
std::vector<Candidate> candidates(const Setting& setting, std::size_t place) {
  if (is_large(setting)) return candidates_of_large(setting, place);
  const auto pick = [&](auto... values) {
    const std::array list{values...};
    return list[place % list.size()];
  };
  const auto samples = static_cast<double>(setting.samples);
  const int levels = std::max(1, static_cast<int>(std::lround(std::log2(samples) / 3)));
  const double outer = std::sqrt(0.75) * side + setting.radius;
  std::vector<Candidate> list{{Technique::brute_force, BruteForceParameters{}}};
  for (const double ratio : {pick(0.4, 0.5, 0.6), pick(0.65, 0.75, 0.55)}) {
    const std::int64_t most = model::sphere_count(Form::corrected, {ratio}, {setting.radius}, {outer});
    list.push_back(
        {Technique::sphere_cache, SphereCacheParameters{ratio, std::max<std::int64_t>(1, most - pick(0, 1, 2))}});
  }
  for (const int depth : {levels, std::max(1, levels - 1)})
    list.push_back({Technique::cell_spheres, CellSpheresParameters{depth}});
  for (const int leaf : {pick(2, 8), pick(16, 64)})
    list.push_back({Technique::sphere_tree, SphereTreeParameters{pick(4, 8, 16), leaf}});
  for (const int leaf : {pick(4, 8, 16), pick(32, 64), pick(128, 256)})
    list.push_back({Technique::box_tree, BoxTreeParameters{pick(4, 16, 8, 2), leaf}});
  for (const int depth : {levels + 1, std::max(1, levels - pick(0, 1)), std::max(0, levels - 2)})
    list.push_back({Technique::octree, OctreeParameters{depth}});
  const double cells = std::max(4.0, std::cbrt(samples));
  for (const double factor : {0.25, pick(0.5, 1.0), 2.0})
    list.push_back({Technique::grid, GridParameters{static_cast<int>(factor * cells)}});
  for (const Technique technique : {Technique::bsp, Technique::bvh, Technique::ray_map})
    list.push_back(default_candidate(technique));
  return list;
}

class Calibrator {
 public:
  explicit Calibrator(const CalibrationOptions& options)
      : options_(options), numbers_(thread_numbers(sim::thread_count(options.threads))) {
    for (const Engine engine : {Engine::plain, Engine::simd}) result_.of(engine).costs = built_in_unit_costs(engine);
  }

  Calibration run() && {
    const std::vector<Setting> all = settings();
    for (std::size_t i = 0; i < all.size() && !is_over(i); ++i) {
      report(watch_.seconds());
      measure(all[i], i);
      ++result_.workloads;
    }
    result_.stopped = options_.stop.stop_requested();
    fit_all();
    result_.seconds = watch_.seconds();
    return std::move(result_);
  }

 private:
  /// The runs of one technique by one engine.
  struct Runs {
    std::vector<TimedRun> on_one_thread;
    std::vector<ThreadedRun> on_more;
  };

  /// The shortest times of the runs of a candidate on one number of threads, each of another run.
  struct Shortest {
    double seconds = std::numeric_limits<double>::infinity();
    double preparing = seconds;
    double processor_seconds = seconds;

    void add(const sim::Outcome& outcome, double processor) {
      seconds = std::min(seconds, outcome.seconds.total());
      preparing = std::min(preparing, outcome.seconds.order + outcome.seconds.build);
      processor_seconds = std::min(processor_seconds, processor);
    }

    [[nodiscard]] bool timed() const { return seconds > 0 && std::isfinite(seconds); }
  };

  /// A candidate of a workload, and its times so far.
  struct Timed {
    Candidate candidate;
    Engine engine;
    Counts<double> counts;
    std::vector<int> numbers = {1};  ///< of threads
    std::vector<Shortest> shortest = {};
    double timed = 0;  ///< seconds, on one thread
  };

  [[nodiscard]] bool is_over(std::size_t place) const {
    return options_.stop.stop_requested() || (place >= least_workloads && watch_.seconds() >= options_.seconds);
  }

  [[nodiscard]] Runs& runs_of(Engine engine, Technique technique) {
    return runs_[static_cast<std::size_t>(engine)][static_cast<std::size_t>(technique)];
  }

  void report(double seconds) const {
    if (!options_.progress) return;
    const double share = std::min(1.0, seconds / options_.seconds);
    options_.progress({fmt::format("workload {}", result_.workloads + 1), share, 1, 0, options_.seconds - seconds});
  }

  void measure(const Setting& setting, std::size_t place) {
    const auto discs = discs_of(setting, place);
    const auto rays = rays_of(setting, discs, place);
    const sim::Problem problem = sim::make_problem(rays, discs);
    for (const Candidate& candidate : candidates(setting, place))
      for (const Engine engine : {Engine::simd, Engine::plain})
        if ((engine == Engine::simd || record_of(candidate.technique).simd) && !is_over(place) &&
            !is_hopeless(setting, candidate.technique, engine))
          measure(problem, setting, candidate, engine, place);
  }

  /// Counts the candidate's operations, then times it, unless it takes too long.
  void measure(const sim::Problem& problem, const Setting& setting, const Candidate& candidate, Engine engine,
               std::size_t place) {
    const double longest = is_large(setting) ? longest_of_large : longest_run;
    const StopAfter limit(options_.stop, longest);
    const sim::Outcome counted = sim::run(problem, candidate, {.engine = engine, .stop = limit.token()});
    if (counted.stopped) too_long_.push_back({candidate.technique, engine, setting});
    if (counted.stopped || counted.seconds.total() > longest) return;
    Timed one{candidate, engine, as_expected(counted.counts)};
    if (place % 2 == 0 && is_divided(one.counts, candidate.technique, engine)) one.numbers = numbers_;
    one.shortest.resize(one.numbers.size());
    for (int i = 0; i < most_repeats && (i < least_repeats || one.timed < enough_timed); ++i) time(problem, one);
    store(one, place);
  }

  /// Whether two threads would be busy.
  [[nodiscard]] static bool is_divided(const Counts<double>& counts, Technique technique, Engine engine) {
    const Pieces pieces = pieces_of(counts, technique, engine);
    return busy_threads(pieces.preparing, 2) > 1 || busy_threads(pieces.search, 2) > 1;
  }

  /// Whether the technique took too long with fewer rays and discs.
  [[nodiscard]] bool is_hopeless(const Setting& setting, Technique technique, Engine engine) const {
    return std::any_of(too_long_.begin(), too_long_.end(), [&](const TooLong& one) {
      return one.technique == technique && one.engine == engine && one.setting.samples <= setting.samples &&
             one.setting.rays <= setting.rays;
    });
  }

  /// Times the candidate once on each number of threads.
  void time(const sim::Problem& problem, Timed& one) {
    for (std::size_t i = 0; i < one.numbers.size(); ++i) {
      const sim::ProcessorStopwatch processor;
      const sim::Outcome outcome =
          sim::run(problem, one.candidate,
                   {.count = false, .engine = one.engine, .stop = options_.stop, .threads = one.numbers[i]});
      if (outcome.stopped) return;
      const double used = processor.seconds();
      one.shortest[i].add(outcome, used);
      if (i > 0) continue;
      const double seconds = outcome.seconds.total();
      one.timed += seconds;
      wall_seconds_ += seconds;
      processor_seconds_ += std::min(used, seconds);
    }
  }

  void store(const Timed& timed, std::size_t place) {
    const Shortest& one = timed.shortest.front();
    if (!one.timed() || !(one.processor_seconds > 0)) return;
    Runs& runs = runs_of(timed.engine, timed.candidate.technique);
    const double seconds = std::min(one.seconds, one.processor_seconds);  // without those of other programs
    runs.on_one_thread.push_back({place, timed.counts, seconds, std::min(one.preparing, seconds)});
    for (std::size_t i = 1; i < timed.numbers.size(); ++i)
      if (const Shortest& more = timed.shortest[i]; more.timed())
        runs.on_more.push_back(
            {place, timed.counts, timed.numbers[i], one.seconds, one.preparing, more.seconds, more.preparing});
  }

  void fit_all() {
    if (wall_seconds_ > 0) result_.processor_share = processor_seconds_ / wall_seconds_;
    std::vector<double> errors;
    std::vector<double> thread_errors;
    for (const Engine engine : {Engine::plain, Engine::simd})
      for (const Technique technique : all_techniques) {
        fit_costs_of(technique, engine, errors);
        fit_threads_of(technique, engine, thread_errors);
      }
    for (const Technique technique : all_techniques)
      if (!record_of(technique).simd) {  // both engines are the same
        result_.plain.costs[technique] = result_.simd.costs[technique];
        result_.plain.costs.threads_of(technique) = result_.simd.costs.threads_of(technique);
      }
    for (const Engine engine : {Engine::plain, Engine::simd})  // always plain
      result_.of(engine).costs[Technique::sphere_cache_published] = result_.plain.costs[Technique::sphere_cache];
    if (!errors.empty()) result_.left_out_median_error = median(std::move(errors));
    if (!thread_errors.empty()) result_.threads_left_out_median_error = median(std::move(thread_errors));
  }

  void fit_costs_of(Technique technique, Engine engine, std::vector<double>& errors) {
    const std::vector<TimedRun>& runs = runs_of(engine, technique).on_one_thread;
    if (runs.size() < 10) return;
    EngineCalibration& result = result_.of(engine);
    const CostFit& fit = result.fits[static_cast<std::size_t>(technique)].emplace(
        fit_costs(runs, technique, built_in_unit_costs(engine)[technique]));
    result.costs[technique] = fit.costs;
    errors.insert(errors.end(), fit.left_out_errors.begin(), fit.left_out_errors.end());
  }

  void fit_threads_of(Technique technique, Engine engine, std::vector<double>& errors) {
    const std::vector<ThreadedRun>& runs = runs_of(engine, technique).on_more;
    if (runs.size() < 5) return;
    const ThreadFit fit = fit_threads(runs, technique, engine, built_in_unit_costs(engine).threads_of(technique));
    if (fit.left_out_errors.empty()) return;  // too few workloads
    EngineCalibration& result = result_.of(engine);
    result.thread_fits[static_cast<std::size_t>(technique)] = fit;
    result.costs.threads_of(technique) = fit.costs;
    errors.insert(errors.end(), fit.left_out_errors.begin(), fit.left_out_errors.end());
  }

  struct TooLong {
    Technique technique;
    Engine engine;
    Setting setting;
  };

  const CalibrationOptions& options_;
  std::vector<int> numbers_;  ///< of threads
  sim::Stopwatch watch_;
  Calibration result_;
  std::array<std::array<Runs, all_techniques.size()>, 2> runs_;  ///< by engine
  double wall_seconds_ = 0;                                      ///< of runs on one thread
  double processor_seconds_ = 0;                                 ///< of these
  std::vector<TooLong> too_long_;
};

}  // namespace

Calibration calibrate(const CalibrationOptions& options) { return Calibrator(options).run(); }

}  // namespace detp::validate
