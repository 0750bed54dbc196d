#include "accuracy_pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/light_notes.hpp"
#include "judged_samples.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t runs = 6;             // of each setting
constexpr std::size_t most_samples = 2000;  // of the runs; times are taken with all
constexpr std::array radii_over_distance{0.25, 0.5, 1.0, 2.0};
constexpr std::array nearest_of_run{5, 10, 20, 40};  // k in a run of the pilot
constexpr double fewest_near = 2;                    // photons within the reference's radius, on average

using Runs = std::vector<std::vector<double>>;

double squared(double x) { return x * x; }

/// Weighted sums over the samples of all runs but number `without`.
struct Sums {
  double noise = 0;   ///< Σ w s²
  double square = 0;  ///< Σ w (m² - s²/R)
};

Sums sums_of(const Runs& all, const std::vector<double>& weights, std::size_t without) {
  Sums sums;
  const auto count = static_cast<double>(all.size() - (without < all.size() ? 1 : 0));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    double mean = 0;
    for (std::size_t r = 0; r < all.size(); ++r) mean += r == without ? 0 : all[r][i] / count;
    double squares = 0;
    for (std::size_t r = 0; r < all.size(); ++r) squares += r == without ? 0 : squared(all[r][i] - mean);
    const double variance = squares / (count - 1);
    sums.noise += weights[i] * variance;
    sums.square += weights[i] * (mean * mean - variance / count);
  }
  return sums;
}

/// With the standard error of the jackknife over the runs.
Estimate jackknife(const Runs& all, const std::vector<double>& weights, double Sums::*value) {
  const auto count = static_cast<double>(all.size());
  std::vector<double> left_out;
  for (std::size_t r = 0; r < all.size(); ++r) left_out.push_back(sums_of(all, weights, r).*value);
  double mean = 0;
  for (const double one : left_out) mean += one / count;
  double squares = 0;
  for (const double one : left_out) squares += squared(one - mean);
  return {sums_of(all, weights, all.size()).*value, std::sqrt((count - 1) / count * squares)};
}

Estimate scaled(const Estimate& one, double factor) { return {one.mean * factor, one.standard_error * factor}; }

Runs difference(const Runs& one, const Runs& other) {
  Runs all = one;
  for (std::size_t r = 0; r < all.size(); ++r)
    for (std::size_t i = 0; i < all[r].size(); ++i) all[r][i] -= other[r][i];
  return all;
}

class PilotMaker {
 public:
  PilotMaker(sim::Scene& scene, const AccuracyPilotOptions& options)
      : scene_(scene),
        options_(options),
        maker_(scene, options.front_facing, options.threads, options.stop),
        judged_(judged_samples(scene, options.reference, most_samples)) {
    pilot_.sample_distance = sim::mean_edge_length(scene.mesh, options.stop);
    if (!(pilot_.sample_distance > 0))
      throw std::invalid_argument("accuracy needs a mesh with triangles; " + scene.name + " has none with edges");
    radii_ = options.radii;
    if (radii_.empty())
      for (const double share : radii_over_distance) radii_.push_back(share * pilot_.sample_distance);
    rays_of_run_ = std::max<std::size_t>(
        200, static_cast<std::size_t>((options.rays > 0 ? options.rays : usual_pilot_rays) / runs));
    const auto all = [&](sim::Estimator one) {
      return options.estimators.empty() || std::ranges::find(options.estimators, one) != options.estimators.end();
    };
    for (const sim::EstimatorRecord& record : sim::estimators)
      if (all(record.estimator) && !record.needs_scene) pilot_.estimators.push_back(with_settings(record.estimator));
  }

  AccuracyPilot make() && {
    trace();
    const Runs reference = options_.reference != nullptr ? given_reference() : reference_runs();
    for (EstimatorPilot& one : pilot_.estimators) measure(one, reference);
    pilot_.rays = static_cast<double>(runs * rays_of_run_);
    pilot_.seconds = watch_.seconds();
    return std::move(pilot_);
  }

 private:
  [[nodiscard]] EstimatorPilot with_settings(sim::Estimator estimator) const {
    EstimatorPilot pilot{.estimator = estimator, .settings = {}};
    if (uses_radius(estimator)) {
      for (const double radius : radii_)
        pilot.settings.push_back(
            {.setting = {estimator, radius}, .scale = radius, .noise_squared_times_rays = {}, .bias_squared = {}});
    } else if (estimator == sim::Estimator::nearest) {
      for (const int k : nearest_of_run)
        pilot.settings.push_back({.setting = {.estimator = estimator, .nearest = k},
                                  .scale = k / static_cast<double>(rays_of_run_),
                                  .noise_squared_times_rays = {},
                                  .bias_squared = {}});
    } else {
      pilot.settings.push_back(
          {.setting = {.estimator = estimator}, .noise_squared_times_rays = {}, .bias_squared = {}});
    }
    return pilot;
  }

  void report(const char* doing) {
    if (options_.progress) options_.progress({doing, 0, 1});
  }

  /// Makes the paths of all runs; a longer run measures the time.
  void trace() {
    report("pilot: tracing");
    double photons = 0;
    double seconds = 0;
    maker_.decide_overshoot();
    for (std::size_t run = 0; run < runs; ++run) {
      sim::Stopwatch watch;
      sim::TracedPaths traced = maker_.trace(rays_of_run_, seed(run), pilot_.sample_distance);
      seconds += watch.seconds() / runs;
      pilot_.light += traced.light;
      paths_.push_back(std::move(traced));
      photons += static_cast<double>(paths_.back().photon_count);
    }
    sim::Stopwatch watch;
    sim::TracedPaths longer = maker_.trace(4 * rays_of_run_, seed(runs), pilot_.sample_distance);
    set_times(seconds, watch.seconds(), pilot_.trace_fixed_seconds, pilot_.trace_seconds_per_ray);
    pilot_.light += longer.light;
    long_paths_ = std::move(longer);
    pilot_.trace_fixed_seconds += maker_.caster_seconds();
    pilot_.photons_per_ray = photons / static_cast<double>(runs * rays_of_run_);
  }

  [[nodiscard]] std::uint64_t seed(std::size_t run) const {
    return options_.seed * 0x9e3779b97f4a7c15ULL + 7919 * (run + 1);
  }

  /// From the times with n and with 4n rays.
  void set_times(double with_one, double with_four, double& fixed, double& per_ray) const {
    const auto n = static_cast<double>(rays_of_run_);
    per_ray = std::max(with_four - with_one, 0.1 * with_four) / (3 * n);
    fixed = std::max(0.0, with_one - per_ray * n);
  }

  Runs runs_of(const AccuracySetting& setting) const {
    Runs all;
    for (const sim::Paths& paths : paths_) all.push_back(maker_.estimate(paths, judged_.samples, setting).irradiance);
    return all;
  }

  /// Photons that count for a sample, on average over the samples by area, in all runs together.
  [[nodiscard]] double photons_near(const AccuracySetting& setting) const {
    const sim::Outcome outcome = maker_.estimate(paths_.front(), judged_.samples, setting);
    double sum = 0;
    for (std::size_t i = 0; i < judged_.weights.size(); ++i)
      sum += judged_.weights[i] * static_cast<double>(outcome.hits[i]);
    return runs * sum;
  }

  /// Chooses the reference's radius, and finds its own bias.
  Runs reference_runs() {
    report("pilot: reference");
    using enum sim::Estimator;
    const double distance = pilot_.sample_distance;
    pilot_.reference_radius = 0.5 * distance;
    if (photons_near({area_corrected, pilot_.reference_radius}) < fewest_near) pilot_.reference_radius = distance;
    Runs reference = runs_of({area_corrected, pilot_.reference_radius});
    const Runs wider = runs_of({area_corrected, 2 * pilot_.reference_radius});
    own_bias_ = jackknife(difference(wider, reference), judged_.weights, &Sums::square);
    own_bias_ = scaled(own_bias_, 1.0 / 3);
    own_bias_ = {std::max(0.0, own_bias_.mean), std::hypot(own_bias_.standard_error, std::max(0.0, own_bias_.mean))};
    const Estimate mean_square = jackknife(reference, judged_.weights, &Sums::square);
    pilot_.mean_square = mean_square.mean;
    if (!(mean_square.mean > 2 * mean_square.standard_error)) throw NoLight(without_light());
    return reference;
  }

  [[nodiscard]] std::string without_light() const {
    const std::vector<std::string> reasons = sim::light_warnings(pilot_.light, scene_.lights);
    return fmt::format("the pilot's {} photons hardly meet the samples of {}: {}", pilot_.light.all_photons(),
                       scene_.name, reasons.empty() ? "do samples lie where the light is?" : reasons.front());
  }

  /// The same values for each run. Their variance is what `own_bias_` subtracts.
  Runs given_reference() {
    const Reference& reference = *options_.reference;
    const auto count = static_cast<double>(reference.samples.size());
    double variance = 0;
    double variance_squares = 0;
    double squares = 0;
    for (std::size_t i = 0; i < reference.samples.size(); ++i) {
      variance += reference.variance[i] / count;
      variance_squares += squared(reference.variance[i] / count);
      squares += squared(reference.irradiance[i]) / count;
    }
    pilot_.mean_square = squares - variance;
    if (!(pilot_.mean_square > 0)) throw NoLight("no light reaches the samples of the reference of " + scene_.name);
    own_bias_ = {-variance, std::sqrt(2 * variance_squares)};
    return Runs(runs, reference.irradiance);
  }

  /// Variance of Σ w (m - b)² because of the reference: 4 Σ w² (m - b)² v. Without a given reference it is in the jackknife.
  [[nodiscard]] double error_by_reference(const Runs& away) const {
    if (options_.reference == nullptr) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < judged_.weights.size(); ++i) {
      double mean = 0;
      for (const auto& run : away) mean += run[i] / static_cast<double>(away.size());
      sum += 4 * squared(judged_.weights[i] * mean) * options_.reference->variance[i];
    }
    return std::sqrt(sum);
  }

  void measure(EstimatorPilot& one, const Runs& reference) {
    report("pilot: estimators");
    for (SettingPilot& setting : one.settings) {
      sim::Stopwatch watch;
      const Runs found = runs_of(setting.setting);
      setting.seconds = watch.seconds() / runs;
      const double square = pilot_.mean_square;
      setting.noise_squared_times_rays =
          scaled(jackknife(found, judged_.weights, &Sums::noise), static_cast<double>(rays_of_run_) / square);
      const Runs away = difference(found, reference);
      const Estimate bias = jackknife(away, judged_.weights, &Sums::square);
      setting.bias_squared =
          scaled({bias.mean + own_bias_.mean,
                  std::hypot(bias.standard_error, own_bias_.standard_error, error_by_reference(away))},
                 1 / square);
    }
    set_seconds(one);
    one.surface_seconds = maker_.surface_seconds(one.estimator);
  }

  /// Times with all samples: those of the middle setting with n and with 4n rays; the others in proportion to the times of the runs.
  void set_seconds(EstimatorPilot& one) const {
    const SettingPilot& middle = one.settings[one.settings.size() / 2];
    sim::Stopwatch watch;
    static_cast<void>(maker_.estimate(paths_.front(), scene_.samples, middle.setting));
    const double with_one = watch.lap();
    static_cast<void>(maker_.estimate(long_paths_, scene_.samples, middle.setting));
    double fixed = 0;
    double per_ray = 0;
    set_times(with_one, watch.lap(), fixed, per_ray);
    one.rays_of_run = static_cast<double>(rays_of_run_);
    one.runs = runs;
    one.fixed_share = std::clamp(fixed / with_one, 0.0, 1.0);
    const double scale = with_one / middle.seconds;
    for (SettingPilot& setting : one.settings) setting.seconds *= scale;
  }

  sim::Scene& scene_;
  const AccuracyPilotOptions& options_;
  sim::Stopwatch watch_;
  ReplicateMaker maker_;
  JudgedSamples judged_;
  AccuracyPilot pilot_;
  std::vector<double> radii_;
  std::size_t rays_of_run_ = 0;
  std::vector<sim::Paths> paths_;
  sim::Paths long_paths_;
  Estimate own_bias_;  ///< squared bias of what the estimates are compared with; below 0: its variance
};

}  // namespace

AccuracyPilot make_accuracy_pilot(sim::Scene& scene, const AccuracyPilotOptions& options) {
  const sim::DefaultFloatingPoint mode;
  return PilotMaker(scene, options).make();
}

}  // namespace detp::validate
