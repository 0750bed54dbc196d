#include "accuracy_check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "accuracy_state.hpp"
#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/estimate/variable_radius.hpp"
#include "detp/sim/ranks/farm.hpp"
#include "detp/validate/base/json.hpp"
#include "judged_samples.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t most_samples_kept = 10'000;  // of each rerun

/// Σ w (a - scale b)².
double square_between(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weights,
                      double scale) {
  double square = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) square += weights[i] * std::pow(a[i] - scale * b[i], 2);
  return square;
}

/// Nothing without a reference; its variance is subtracted.
std::optional<double> error_of(const std::vector<double>& found, const Reference* reference, double mean_square) {
  if (reference == nullptr) return std::nullopt;
  double square = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    square +=
        reference->judged.weights[i] * (std::pow(found[i] - reference->irradiance[i], 2) - reference->variance[i]);
  return std::sqrt(std::max(0.0, square / mean_square));
}

JudgedSamples judged_in(const sim::Scene& scene, const AccuracyPilotOptions& options, std::size_t most) {
  return options.reference != nullptr ? options.reference->judged : judged_samples(scene, most, options.weights);
}

/// Nothing without a reference.
std::optional<double> share_within(const std::vector<double>& found, const Reference* reference, double error) {
  if (reference == nullptr) return std::nullopt;
  double count = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    count += std::abs(found[i] - reference->irradiance[i]) <= error ? 1 : 0;
  return count / static_cast<double>(found.size());
}

/// One run, with the time that it takes at all of the scene's samples.
struct TimedEstimate {
  sim::Paths paths;
  std::vector<double> irradiance;  ///< at the judged samples
  std::vector<double> variance;    ///< of backward paths; else empty
  double trace_seconds = 0;
  double seconds = 0;  ///< with tracing
};

TimedEstimate timed_gather(const ReplicateMaker& maker, const sim::Scene& scene, const JudgedSamples& judged,
                           std::uint64_t paths, std::uint64_t seed) {
  const sim::Stopwatch watch;
  const std::vector<sim::PathSums> sums = maker.gather(scene.samples, paths, seed);
  TimedEstimate run{.paths = {}, .irradiance = {}, .variance = {}, .seconds = maker.caster_seconds() + watch.seconds()};
  for (const std::size_t place : judged.places) {
    run.irradiance.push_back(sums[place].irradiance());
    run.variance.push_back(sums[place].variance());
  }
  return run;
}

TimedEstimate timed_estimate(ReplicateMaker& maker, const sim::Scene& scene, const JudgedSamples& judged,
                             const AccuracySetting& setting, double rays, std::uint64_t seed) {
  const auto count = static_cast<std::size_t>(std::max(2.0, std::ceil(rays)));
  if (setting.estimator == sim::Estimator::gather) return timed_gather(maker, scene, judged, count, seed);
  if (setting.radius > 0) maker.decide_overshoot();
  sim::Stopwatch watch;
  TimedEstimate run{.paths = maker.trace(count, seed, setting.radius), .irradiance = {}, .variance = {}};
  run.trace_seconds = maker.caster_seconds() + watch.lap();
  const auto all = maker.estimate(run.paths, scene.samples, setting).irradiance;
  run.seconds = run.trace_seconds + watch.lap();
  run.irradiance = judged.of_all(all);
  return run;
}

/// Of one run: by the variance of its backward paths, or with the estimate of half of its photons, since the variance of the difference is
/// that of the whole run. Both have the same radii, also of variable-radius: half of the photons alone would make larger ones.
double noise_squared(const ReplicateMaker& maker, const sim::Scene& scene, const AccuracyPilotOptions& options,
                     const JudgedSamples& judged, const AccuracyPoint& point, const TimedEstimate& whole) {
  if (!whole.variance.empty())
    return std::inner_product(judged.weights.begin(), judged.weights.end(), whole.variance.begin(), 0.0);
  AccuracySetting of_half = point.setting();
  if (of_half.estimator == sim::Estimator::nearest) of_half.nearest = std::max(3, of_half.nearest / 2);
  const std::uint64_t photons = std::max<std::uint64_t>(1, whole.paths.photon_count / 2);
  const double scale = static_cast<double>(whole.paths.photon_count) / static_cast<double>(photons);
  std::vector<double> radii;
  std::vector<double> all = whole.irradiance;
  if (point.estimator == sim::Estimator::variable_radius) {
    of_half = {sim::Estimator::disc, point.radius};
    const PilotRadii by_pilot(scene, judged.places, judged.population, options.relative);
    const auto first = static_cast<std::uint64_t>(sim::pilot_share * static_cast<double>(whole.paths.photon_count));
    const sim::PathRays pilot = first_photons(whole.paths, std::max<std::uint64_t>(1, first));
    radii = by_pilot.of(point.radius, by_pilot.hits(maker, pilot, point.radius));
    all = maker.estimate(whole.paths, judged.samples, of_half, false, radii).irradiance;
  }
  const auto half =
      maker.estimate(first_photons(whole.paths, photons), judged.samples, of_half, false, radii).irradiance;
  return square_between(all, half, judged.weights, scale) / std::max(1e-9, scale - 1);
}

/// What a rank makes in a rerun.
struct RerunTask {
  AccuracySetting setting;
  double rays = 0;
  std::uint64_t seed = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RerunTask, setting, rays, seed)

/// Makes reruns on one process or on ranks.
class RerunMaker {
 public:
  RerunMaker(sim::Scene& scene, const AccuracyPilotOptions& options)
      : scene_(scene),
        options_(options),
        judged_(judged_in(scene, options, most_samples_kept)),
        work_([this](const std::string& task) { return json_bytes(make(from_json_bytes<RerunTask>(task))); }),
        farm_(options.ranks != nullptr ? *options.ranks : one_, work_) {}

  [[nodiscard]] const JudgedSamples& judged() const { return judged_; }
  [[nodiscard]] std::uint64_t at_once() const {
    return options_.ranks == nullptr ? 1 : static_cast<std::uint64_t>(options_.ranks->count());
  }

  /// With the seeds first … last - 1; without errors.
  [[nodiscard]] std::vector<AccuracyRerun> make(const AccuracyPoint& point, std::uint64_t first, std::uint64_t last) {
    std::vector<std::string> tasks;
    for (std::uint64_t seed = first; seed < last; ++seed)
      tasks.push_back(json_bytes(RerunTask{point.setting(), point.rays, seed}));
    std::vector<AccuracyRerun> runs;
    for (const std::string& run : farm_.all(tasks)) runs.push_back(from_json_bytes<AccuracyRerun>(run));
    return runs;
  }

  void serve() { farm_.serve(); }

 private:
  [[nodiscard]] AccuracyRerun make(const RerunTask& task) {
    ReplicateMaker maker(scene_, options_.front_facing, options_.threads, options_.stop);
    TimedEstimate run = timed_estimate(maker, scene_, judged_, task.setting, task.rays, task.seed);
    return {.seed = task.seed, .seconds = run.seconds, .irradiance = std::move(run.irradiance)};
  }

  sim::Scene& scene_;
  const AccuracyPilotOptions& options_;
  JudgedSamples judged_;
  sim::OneRank one_;
  sim::Farm::Work work_;
  sim::Farm farm_;
};

}  // namespace

AccuracyCheck check_accuracy(sim::Scene& scene, const AccuracyPoint& point, double mean_square,
                             const AccuracyPilotOptions& options, double within) {
  const sim::DefaultFloatingPoint mode;
  ReplicateMaker maker(scene, options.front_facing, options.threads, options.stop);
  const JudgedSamples judged = judged_in(scene, options, scene.samples.size());
  const TimedEstimate whole = timed_estimate(maker, scene, judged, point.setting(), point.rays, options.seed);
  return {.point = point,
          .noise = std::sqrt(noise_squared(maker, scene, options, judged, point, whole) / mean_square),
          .seconds = whole.seconds,
          .trace_seconds = whole.trace_seconds,
          .rays = point.gathers() ? point.rays : static_cast<double>(whole.paths.rays.size()),
          .error = error_of(whole.irradiance, options.reference, mean_square),
          .share_within = share_within(whole.irradiance, options.reference, within * std::sqrt(mean_square))};
}

AccuracyPilot with_check(AccuracyPilot pilot, const AccuracyCheck& check) {
  const AccuracyPoint& point = check.point;
  const auto own = std::ranges::find(pilot.estimators, point.estimator, &EstimatorPilot::estimator);
  if (own == pilot.estimators.end() || !(check.noise > 0) || point.gathers()) return pilot;
  // Each ray of both says as much of the noise² of one ray.
  const double ratio = std::pow(check.noise / point.noise.value, 2) * check.rays / point.rays;
  const double pooled = (own->noise_rays + ratio * check.rays) / (own->noise_rays + check.rays);
  for (SettingPilot& setting : own->settings) {
    setting.noise_squared_times_rays.mean *= pooled;
    setting.noise_squared_times_rays.standard_error *= pooled;
  }
  return pilot;
}

void check(const RerunSeeds& seeds) {
  require_count("number of seeds", static_cast<double>(seeds.last) - static_cast<double>(seeds.first) + 1, 2, 1e6);
}

std::vector<AccuracyRerun> rerun_accuracy(sim::Scene& scene, const AccuracyPoint& point, double mean_square,
                                          const RerunSeeds& seeds, const AccuracyPilotOptions& options,
                                          std::vector<AccuracyRerun> made,
                                          const std::function<void(const std::vector<AccuracyRerun>&)>& save) {
  const sim::DefaultFloatingPoint mode;
  check(seeds);
  const std::uint64_t count = seeds.count();
  RerunMaker maker(scene, options);
  const JudgedSamples& judged = maker.judged();
  for (std::size_t i = 0; i < made.size(); ++i)
    if (made.size() > count || made[i].seed != seeds.first + i || made[i].irradiance.size() != judged.samples.size())
      throw std::invalid_argument("runs that were made with other seeds, or at other samples");
  try {
    while (made.size() < count) {
      if (options.progress)
        options.progress({"runs", static_cast<double>(made.size()) / static_cast<double>(count), 1});
      const std::uint64_t next = seeds.first + made.size();
      for (AccuracyRerun& run : maker.make(point, next, std::min(seeds.first + count, next + maker.at_once()))) {
        run.error = error_of(run.irradiance, options.reference, mean_square);
        made.push_back(std::move(run));
      }
      if (save) save(made);
    }
  } catch (const sim::Stopped&) {  // the runs made so far answer
  }
  if (made.size() < 2) return {};
  const auto runs = static_cast<double>(made.size());
  std::vector<double> mean(judged.samples.size());
  for (const AccuracyRerun& run : made)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += run.irradiance[i] / runs;
  for (AccuracyRerun& run : made) {
    const double square = square_between(run.irradiance, mean, judged.weights, 1) / mean_square;
    run.noise = std::sqrt(square * runs / (runs - 1));
  }
  return made;
}

void serve_reruns(sim::Scene& scene, const AccuracyPilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  RerunMaker(scene, options).serve();
}

}  // namespace detp::validate
