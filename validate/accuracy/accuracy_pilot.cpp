#include "accuracy_pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/light_notes.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t runs = 8;               // of each setting
constexpr std::size_t samples_judged = 1000;  // of the runs; times are taken with all
constexpr std::array radii_over_distance{0.25, 0.5, 1.0, 2.0};
constexpr std::array nearest_of_run{5, 10, 20, 40};  // k in a run of the pilot
constexpr int batches_of_missed_light = 8;
constexpr double first_photons_of_a_batch = 1 << 14;
constexpr double patch_over_edge =
    0.25;  // of missed light: more than in references, or a pilot's photons would be too few

Estimate scaled(const Estimate& one, double factor) { return {one.mean * factor, one.standard_error * factor}; }

}  // namespace

/// The runs of one pilot.
class PilotMaker::Runs {
 public:
  Runs(PilotMaker& of, double rays, const AccuracyPilot* before) : of_(of), options_(of.options_), before_(before) {
    pilot_.sample_distance = sim::mean_edge_length(of.scene_.mesh, options_.stop);
    if (!(pilot_.sample_distance > 0))
      throw std::invalid_argument("accuracy needs a mesh with triangles; " + of.scene_.name + " has none with edges");
    radii_ = options_.radii;
    if (radii_.empty())
      for (const double share : radii_over_distance) radii_.push_back(share * pilot_.sample_distance);
    rays_of_run_ = std::max<std::size_t>(200, static_cast<std::size_t>(rays / runs));
    for (std::size_t place : of.judged_.places)
      if (!options_.relative.empty()) relative_.push_back(options_.relative[place]);
    const auto wanted = [&](sim::Estimator one) {
      return options_.estimators.empty() || std::ranges::find(options_.estimators, one) != options_.estimators.end();
    };
    for (const sim::EstimatorRecord& record : sim::estimators)
      if (wanted(record.estimator)) pilot_.estimators.push_back(with_settings(record.estimator));
  }

  /// `reference`: the truth; `by_paths`: what gather finds.
  AccuracyPilot make(const Reference& reference, const Reference& by_paths) && {
    pilot_.mean_square = reference.mean_square();
    report("pilot: tracing");
    trace();
    if (!(pilot_.mean_square > 0)) throw NoLight(without_light());
    report("pilot: estimators");
    for (EstimatorPilot& one : pilot_.estimators)
      if (one.estimator != sim::Estimator::gather) measure(one, reference);
    const auto by_photons = [](const EstimatorPilot& one) { return one.estimator != sim::Estimator::gather; };
    if (!met_ && std::ranges::any_of(pilot_.estimators, by_photons)) throw NoLight(without_light());
    for (EstimatorPilot& one : pilot_.estimators)
      if (one.estimator == sim::Estimator::gather) measure_gather(one, by_paths);
    pilot_.rays = static_cast<double>(runs * rays_of_run_);
    pilot_.judge = {reference.kind,    reference.paths,   reference.photons,    reference.judged.samples.size(),
                    reference.error(), reference.seconds, reference.missed_mean};
    pilot_.seconds = watch_.seconds();
    return std::move(pilot_);
  }

 private:
  [[nodiscard]] EstimatorPilot with_settings(sim::Estimator estimator) const {
    EstimatorPilot pilot{.estimator = estimator, .settings = {}};
    const auto add = [&](const AccuracySetting& setting, double scale) {
      SettingPilot one;
      one.setting = setting;
      one.scale = scale;
      pilot.settings.push_back(one);
    };
    if (uses_radius(estimator))
      for (const double radius : radii_) add({estimator, radius}, radius);
    else if (estimator == sim::Estimator::nearest)
      for (const int k : nearest_of_run)
        add({.estimator = estimator, .nearest = k}, k / static_cast<double>(rays_of_run_));
    else
      add({.estimator = estimator}, 1);
    return pilot;
  }

  void report(const char* doing) {
    if (options_.progress) options_.progress({doing, 0, 1});
  }

  /// Makes the paths of all runs; a longer run measures the time.
  void trace() {
    double photons = 0;
    double seconds = 0;
    ReplicateMaker& maker = of_.maker_;
    maker.decide_overshoot();
    for (std::size_t run = 0; run < runs; ++run) {
      sim::Stopwatch watch;
      sim::TracedPaths traced = maker.trace(rays_of_run_, seed(run), radii_.back());
      seconds += watch.seconds() / runs;
      pilot_.light += traced.light;
      paths_.push_back(std::move(traced));
      photons += static_cast<double>(paths_.back().photon_count);
    }
    sim::Stopwatch watch;
    sim::TracedPaths longer = maker.trace(4 * rays_of_run_, seed(runs), radii_.back());
    set_times(seconds, watch.seconds(), pilot_.trace_fixed_seconds, pilot_.trace_seconds_per_ray);
    pilot_.light += longer.light;
    long_paths_ = std::move(longer);
    pilot_.trace_fixed_seconds += maker.caster_seconds();
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

  [[nodiscard]] std::vector<std::vector<double>> runs_of(const AccuracySetting& setting) {
    const double overshoot = of_.maker_.overshoot(uses_radius(setting.estimator) ? setting.radius : 0);
    std::vector<std::vector<double>> all;
    for (const sim::Paths& paths : paths_) {
      const std::vector<sim::Ray> rays = with_overshoot(paths, of_.scene_, overshoot);
      sim::PathRays same = paths;
      same.rays = rays;
      all.push_back(of_.maker_.estimate(same, of_.judged_.samples, setting, false, relative_).irradiance);
    }
    return all;
  }

  [[nodiscard]] std::string without_light() const {
    const std::vector<std::string> reasons = sim::light_warnings(pilot_.light, of_.scene_.lights);
    return fmt::format("the pilot's {} photons hardly meet the samples of {}: {}", pilot_.light.all_photons(),
                       of_.scene_.name, reasons.empty() ? "do samples lie where the light is?" : reasons.front());
  }

  [[nodiscard]] const EstimatorPilot* earlier(sim::Estimator estimator) const {
    if (before_ == nullptr) return nullptr;
    const auto found = std::ranges::find(before_->estimators, estimator, &EstimatorPilot::estimator);
    return found == before_->estimators.end() ? nullptr : &*found;
  }
  /// The earlier pilot of an estimator that is settled at all settings; else null.
  [[nodiscard]] const EstimatorPilot* settled_whole(sim::Estimator estimator) const {
    const EstimatorPilot* one = earlier(estimator);
    return one != nullptr && std::ranges::all_of(one->settings, &SettingPilot::settled) ? one : nullptr;
  }
  /// The earlier pilot, if its settings are those of this one; else null.
  [[nodiscard]] const EstimatorPilot* settled_part(const EstimatorPilot& one) const {
    return uses_radius(one.estimator) ? earlier(one.estimator) : nullptr;
  }

  void measure(EstimatorPilot& one, const Reference& reference) {
    if (const EstimatorPilot* all = settled_whole(one.estimator)) {
      one = *all;
      met_ = true;
      return;
    }
    double variance = 0;
    double by_reference = 0;
    const EstimatorPilot* earlier = settled_part(one);
    for (std::size_t i = 0; i < one.settings.size(); ++i) {
      SettingPilot& setting = one.settings[i];
      if (earlier != nullptr && earlier->settings[i].settled) {
        setting = earlier->settings[i];
        setting.seconds *= static_cast<double>(rays_of_run_) / earlier->rays_of_run;
        continue;
      }
      sim::Stopwatch watch;
      const auto found = runs_of(setting.setting);
      setting.seconds = watch.seconds() / runs;
      for (const auto& run : found) met_ = met_ || std::ranges::any_of(run, [](double one) { return one > 0; });
      const ErrorSplit split = split_error(found, reference.values());
      setting.noise_squared_times_rays = scaled(split.noise_squared, static_cast<double>(rays_of_run_));
      setting.bias_squared = split.bias_squared;
      setting.mean_bias = split.mean_bias;
      variance += std::pow(split.bias_squared.standard_error, 2);
      by_reference += split.by_reference;
    }
    one.by_reference = variance > 0 ? by_reference / variance : 0;
    set_seconds(one);
    one.surface_seconds = of_.maker_.surface_seconds(one.estimator);
  }

  /// Rays are backward paths of one sample, on each side.
  void measure_gather(EstimatorPilot& one, const Reference& reference) const {
    SettingPilot& setting = one.settings.front();
    const auto paths = static_cast<double>(std::max<std::uint64_t>(1, reference.paths));
    const auto samples = static_cast<double>(of_.scene_.samples.size());
    const double noise = reference.path_noise_squared;
    const auto judged = static_cast<double>(of_.judged_.samples.size());
    // noise_squared_error: of its mean at the judged samples, and of one run at all samples
    const double error = std::sqrt((2 / judged + 2 / samples) / static_cast<double>(runs + 1));
    setting.noise_squared_times_rays = {noise, noise * error};
    setting.bias_squared = reference.missed_squared;
    setting.mean_bias = {-reference.missed_mean, 0};
    setting.seconds = reference.seconds_of_path * samples * paths;
    one.rays_of_run = paths;
    one.runs = runs;
    one.surface_seconds = of_.maker_.caster_seconds();
  }

  /// Times with all samples: those of the middle setting with n and with 4n rays; the others in proportion to the times of the runs.
  void set_seconds(EstimatorPilot& one) const {
    std::vector<const SettingPilot*> timed;
    for (const SettingPilot& setting : one.settings)
      if (!setting.settled) timed.push_back(&setting);
    const SettingPilot& middle = *timed[timed.size() / 2];
    const auto time = [&](const sim::Paths& paths) {
      sim::Stopwatch watch;
      static_cast<void>(of_.maker_.estimate(paths, of_.scene_.samples, middle.setting, false, options_.relative));
      return watch.seconds();
    };
    const double with_one = time(paths_.front());
    double fixed = 0;
    double per_ray = 0;
    set_times(with_one, time(long_paths_), fixed, per_ray);
    one.rays_of_run = static_cast<double>(rays_of_run_);
    one.runs = runs;
    one.fixed_share = std::clamp(fixed / with_one, 0.0, 1.0);
    const double scale = with_one / middle.seconds;
    for (SettingPilot& setting : one.settings)
      if (!setting.settled) setting.seconds *= scale;
  }

  PilotMaker& of_;
  const AccuracyPilotOptions& options_;
  const AccuracyPilot* before_;
  sim::Stopwatch watch_;
  AccuracyPilot pilot_;
  std::vector<double> radii_;
  std::vector<double> relative_;
  std::size_t rays_of_run_ = 0;
  std::vector<sim::Paths> paths_;
  sim::Paths long_paths_;
  bool met_ = false;  ///< some photon met some sample
};

PilotMaker::PilotMaker(sim::Scene& scene, AccuracyPilotOptions options)
    : scene_(scene),
      options_(std::move(options)),
      maker_(scene, options_.front_facing, options_.threads, options_.stop) {
  judged_ = options_.reference != nullptr ? options_.reference->judged
            : options_.weights.empty()    ? judged_samples(scene, samples_judged)
                                          : judged_samples(scene, options_.weights, samples_judged);
  const ReferenceOptions judge{.seed = options_.seed,
                               .patch_radius = patch_over_edge * sim::mean_edge_length(scene.mesh, options_.stop),
                               .front_facing = options_.front_facing,
                               .threads = options_.threads,
                               .stop = options_.stop};
  judge_.emplace(scene, judged_, judge, maker_.caster());
}

PilotMaker::~PilotMaker() = default;

std::uint64_t PilotMaker::first_paths() const {
  constexpr std::uint64_t of_all = 64 * samples_judged;
  return options_.paths > 0 ? options_.paths : of_all / judged_.samples.size();
}

AccuracyPilot PilotMaker::make(double rays, std::uint64_t paths, const AccuracyPilot* before) {
  const sim::DefaultFloatingPoint mode;
  const sim::Stopwatch watch;
  Runs all(*this, rays, before);
  if (options_.progress) options_.progress({"pilot: backward paths", 0, 1});
  judge_->add_paths(paths);
  const double more = static_cast<double>(paths) / static_cast<double>(first_paths());
  judge_->add_photons(static_cast<std::uint64_t>(more * first_photons_of_a_batch), batches_of_missed_light);
  const Reference& by_paths = judge_->reference();
  AccuracyPilot pilot = std::move(all).make(options_.reference != nullptr ? *options_.reference : by_paths, by_paths);
  pilot.seconds = watch.seconds();
  return pilot;
}

AccuracyPilot make_accuracy_pilot(sim::Scene& scene, const AccuracyPilotOptions& options) {
  PilotMaker maker(scene, options);
  return maker.make(options.rays > 0 ? options.rays : usual_pilot_rays, maker.first_paths());
}

}  // namespace detp::validate
