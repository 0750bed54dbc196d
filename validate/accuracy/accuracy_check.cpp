#include "accuracy_check.hpp"

#include <algorithm>
#include <cmath>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t most_samples_kept = 2000;  // of each rerun

std::size_t whole_rays(const AccuracyPoint& point) {
  return static_cast<std::size_t>(std::max(2.0, std::ceil(point.rays)));
}

/// Σ w (a - scale b)².
double square_between(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weights,
                      double scale) {
  double square = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) square += weights[i] * std::pow(a[i] - scale * b[i], 2);
  return square;
}

/// Where errors are taken: at the samples of the reference, if there is one, else at up to `most` of the scene's.
struct JudgedSamples {
  std::vector<sim::Sample> samples;
  std::vector<double> weights;
  const Reference* reference = nullptr;

  /// Nothing without a reference; its variance is subtracted.
  [[nodiscard]] std::optional<double> error_of(const std::vector<double>& found, double mean_square) const {
    if (reference == nullptr) return std::nullopt;
    double square = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      square += weights[i] * (std::pow(found[i] - reference->irradiance[i], 2) - reference->variance[i]);
    return std::sqrt(std::max(0.0, square / mean_square));
  }
};

JudgedSamples judged_samples(const sim::Scene& scene, const Reference* reference, std::size_t most) {
  if (reference != nullptr)
    return {reference->samples,
            std::vector<double>(reference->samples.size(), 1 / static_cast<double>(reference->samples.size())),
            reference};
  const std::vector<double> weights = area_weights(scene);
  const std::size_t step = (weights.size() - 1) / most + 1;
  JudgedSamples judged;
  double sum = 0;
  for (std::size_t i = step / 2; i < weights.size(); i += step) {
    judged.samples.push_back(scene.samples[i]);
    sum += judged.weights.emplace_back(weights[i]);
  }
  for (double& weight : judged.weights) weight /= sum;
  return judged;
}

}  // namespace

AccuracyCheck check_accuracy(sim::Scene& scene, const AccuracyPoint& point, double mean_square,
                             const AccuracyPilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  ReplicateMaker maker(scene, options.front_facing, options.threads, options.stop);
  maker.decide_overshoot(point.radius);
  const AccuracySetting setting = point.setting();
  const JudgedSamples judged = judged_samples(scene, options.reference, scene.samples.size());
  AccuracyCheck check;
  sim::Stopwatch watch;
  const sim::Paths paths = maker.trace(whole_rays(point), options.seed, point.radius);
  check.rays = static_cast<double>(paths.rays.size());
  check.trace_seconds = maker.caster_seconds() + watch.lap();
  auto whole = maker.estimate(paths, scene.samples, setting).irradiance;
  check.seconds = check.trace_seconds + watch.lap();
  if (judged.reference != nullptr) whole = maker.estimate(paths, judged.samples, setting).irradiance;
  // Half of the photons: the variance of the difference is that of the whole run.
  AccuracySetting of_half = setting;
  if (setting.estimator == sim::Estimator::nearest) of_half.nearest = std::max(3, setting.nearest / 2);
  const std::uint64_t photons = std::max<std::uint64_t>(1, paths.photon_count / 2);
  const double scale = static_cast<double>(paths.photon_count) / static_cast<double>(photons);
  const auto half = maker.estimate(first_photons(paths, photons), judged.samples, of_half).irradiance;
  check.noise = std::sqrt(square_between(whole, half, judged.weights, scale) / mean_square / std::max(1e-9, scale - 1));
  check.error = judged.error_of(whole, mean_square);
  return check;
}

double correct(AccuracyPlan& plan, const AccuracyCheck& check) {
  constexpr double clearly = 0.1;
  AccuracyPoint& best = plan.answer;
  const double ratio = check.noise / best.noise;
  if (plan.target.kind != AccuracyTarget::Kind::noise || !plan.reached || !(ratio > 0) || std::abs(ratio - 1) < clearly)
    return 1;
  const double factor = ratio * ratio;
  best.rays *= factor;
  best.photons *= factor;
  best.seconds = check.seconds * factor;
  best.trace_seconds = check.trace_seconds * factor;
  if (best.nearest > 0) best.nearest = static_cast<int>(std::clamp(std::round(best.nearest * factor), 3.0, 1e9));
  return factor;
}

std::vector<AccuracyRerun> rerun_accuracy(sim::Scene& scene, const AccuracyPoint& point, double mean_square,
                                          std::uint64_t first, std::uint64_t last,
                                          const AccuracyPilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  const std::uint64_t count = last - first + 1;
  require_count("number of seeds", static_cast<double>(last) - static_cast<double>(first) + 1, 2, 1e6);
  const JudgedSamples judged = judged_samples(scene, options.reference, most_samples_kept);
  std::vector<AccuracyRerun> reruns;
  std::vector<std::vector<double>> found;
  try {
    for (std::uint64_t seed = first; reruns.size() < count; ++seed) {
      if (options.progress)
        options.progress({"runs", static_cast<double>(reruns.size()) / static_cast<double>(count), 1});
      ReplicateMaker maker(scene, options.front_facing, options.threads, options.stop);
      maker.decide_overshoot(point.radius);
      const sim::Stopwatch watch;
      const sim::Paths paths = maker.trace(whole_rays(point), seed, point.radius);
      static_cast<void>(maker.estimate(paths, scene.samples, point.setting()));
      const double seconds = maker.caster_seconds() + watch.seconds();
      found.push_back(maker.estimate(paths, judged.samples, point.setting()).irradiance);
      reruns.push_back({.seed = seed, .seconds = seconds, .error = judged.error_of(found.back(), mean_square)});
    }
  } catch (const sim::Stopped&) {
    found.resize(reruns.size());
  }
  if (reruns.size() < 2) return {};
  const auto runs = static_cast<double>(reruns.size());
  std::vector<double> mean(judged.samples.size());
  for (const auto& run : found)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += run[i] / runs;
  for (std::size_t r = 0; r < reruns.size(); ++r)
    reruns[r].noise = std::sqrt(square_between(found[r], mean, judged.weights, 1) / mean_square * runs / (runs - 1));
  return reruns;
}

}  // namespace detp::validate
