#include "accuracy_pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/photons/light_ledger.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t runs = 8;               // of each setting
constexpr std::size_t samples_judged = 1000;  // at most, by the runs
constexpr std::array radii_over_distance{0.25, 0.5, 1.0, 2.0};
constexpr std::array nearest_of_run{5, 10, 20, 40};  // k in a run of the pilot
constexpr int batches_of_missed_light = 8;
constexpr double first_photons_of_a_batch = 1 << 12;
// Of missed light: twice that of references, because a pilot has few photons.
constexpr double patch_over_edge = 0.25;

Estimate scaled(const Estimate& one, double factor) { return {one.mean * factor, one.standard_error * factor}; }

}  // namespace

/// The runs of one pilot.
class PilotMaker::Runs {
 public:
  Runs(PilotMaker& of, double rays, const AccuracyPilot* before)
      : of_(of),
        before_(before),
        radii_of_others_(of.scene_, of.judged_.places, of.judged_.population, of.options_.relative),
        rays_of_run_(std::max<std::size_t>(200, static_cast<std::size_t>(rays / runs))) {
    pilot_.sample_distance = of.edge_;
    pilot_.trace = of.costs_.trace();
    pilot_.rays = static_cast<double>(runs * rays_of_run_);
    pilot_.estimators = of.settings_of(static_cast<double>(rays_of_run_));
    if (!of.options_.relative.empty()) relative_ = of.judged_.of_all(of.options_.relative);
  }

  /// `reference`: the truth; `by_paths`: what gather finds.
  AccuracyPilot make(const Reference& reference, const Reference& by_paths) && {
    pilot_.casts_per_path = by_paths.casts_per_path;
    pilot_.mean_square = pilot_.judged_square = reference.mean_square();
    of_.report("pilot: tracing");
    trace();
    if (!(pilot_.mean_square > 0)) throw NoLight(without_light());
    of_.report("pilot: estimators");
    bool by_photons = false;
    for (EstimatorPilot& one : pilot_.estimators) {
      const bool gathers = one.estimator == sim::Estimator::gather;
      by_photons = by_photons || !gathers;
      if (gathers)
        measure_gather(one, by_paths);
      else
        measure(one, reference);
    }
    if (by_photons && !met_) throw NoLight(without_light());
    pilot_.judge = {reference.kind,    reference.paths,   reference.photons,    reference.judged.samples.size(),
                    reference.error(), reference.seconds, reference.missed_mean};
    return std::move(pilot_);
  }

 private:
  /// Makes the paths of all runs.
  void trace() {
    double photons = 0;
    of_.maker_.decide_overshoot();
    for (std::size_t run = 0; run < runs; ++run) {
      sim::TracedPaths traced = of_.maker_.trace(rays_of_run_, seed(run), of_.options_.radii.back());
      pilot_.light += traced.light;
      paths_.push_back(std::move(traced));
      photons += static_cast<double>(paths_.back().photon_count);
    }
    pilot_.photons_per_ray = photons / pilot_.rays;
  }

  [[nodiscard]] std::uint64_t seed(std::size_t run) const {
    return of_.options_.seed * 0x9e3779b97f4a7c15ULL + 7919 * (run + 1);
  }

  /// The irradiance of the runs at the judged samples.
  struct Found {
    std::vector<std::vector<double>> irradiance;
    double hits = 0;  ///< of all runs
  };

  [[nodiscard]] Found runs_of(const AccuracySetting& setting) {
    const double overshoot = of_.maker_.overshoot(uses_radius(setting.estimator) ? setting.radius : 0);
    std::vector<std::vector<sim::Ray>> rays;
    std::vector<sim::PathRays> paths;
    for (const sim::Paths& one : paths_) {
      paths.emplace_back(one).rays = rays.emplace_back(with_overshoot(one, of_.scene_, overshoot));
    }
    const bool varies = setting.estimator == sim::Estimator::variable_radius;
    std::vector<std::vector<std::uint64_t>> hits;
    std::vector<std::uint64_t> all_hits;
    for (std::size_t run = 0; varies && run < runs; ++run) {
      hits.push_back(radii_of_others_.hits(of_.maker_, paths[run], setting.radius));
      all_hits.resize(hits.back().size());
      for (std::size_t i = 0; i < all_hits.size(); ++i) all_hits[i] += hits.back()[i];
    }
    Found all;
    for (std::size_t run = 0; run < runs; ++run) {
      AccuracySetting of_run = setting;
      std::vector<double> radii = relative_;
      if (varies) {
        of_run.estimator = sim::Estimator::disc;
        std::vector<std::uint64_t> others = all_hits;
        for (std::size_t i = 0; i < others.size(); ++i) others[i] -= hits[run][i];
        radii = radii_of_others_.of(setting.radius, others);
      }
      sim::Outcome outcome = of_.maker_.estimate(paths[run], of_.judged_.samples, of_run, false, radii);
      all.irradiance.push_back(std::move(outcome.irradiance));
      all.hits += static_cast<double>(outcome.total_hits);
    }
    return all;
  }

  [[nodiscard]] std::string without_light() const {
    const std::vector<std::string> reasons = sim::light_warnings(pilot_.light, of_.scene_.lights);
    return fmt::format("the pilot's {} photons hardly meet the samples of {}: {}", pilot_.light.all_photons(),
                       of_.scene_.name, reasons.empty() ? "do samples lie where the light is?" : reasons.front());
  }

  void measure(EstimatorPilot& one, const Reference& reference) {
    const EstimatorPilot* const earlier = before_ != nullptr ? &before_->of(one.estimator) : nullptr;
    if (earlier != nullptr && std::ranges::all_of(earlier->settings, &SettingPilot::settled)) {
      one = *earlier;
      met_ = true;
      return;
    }
    double variance = 0;
    double by_reference = 0;
    for (std::size_t i = 0; i < one.settings.size(); ++i) {
      SettingPilot& setting = one.settings[i];
      // radii are the same as before; others change with the number of rays
      if (earlier != nullptr && uses_radius(one.estimator) && earlier->settings[i].settled) {
        setting = earlier->settings[i];
        continue;
      }
      const Found found = runs_of(setting.setting);
      setting.seconds = of_.seconds_of(setting, found.hits / pilot_.rays);
      for (const auto& run : found.irradiance)
        met_ = met_ || std::ranges::any_of(run, [](double of_sample) { return of_sample > 0; });
      const ErrorSplit split = split_error(found.irradiance, reference.values());
      // a photon that meets several discs brings as many terms
      const double of_photon = std::max(1.0, found.hits / (pilot_.rays * pilot_.photons_per_ray));
      if (split.noise_terms > 0) setting.rare_photons = std::max(1.0, split.noise_terms / of_photon);
      setting.noise_squared_times_rays = scaled(split.noise_squared, static_cast<double>(rays_of_run_));
      setting.bias_squared = split.bias_squared;
      setting.mean_bias = split.mean_bias;
      variance += std::pow(split.bias_squared.standard_error, 2);
      by_reference += split.by_reference;
    }
    one.runs = runs;
    one.noise_rays = pilot_.rays;
    one.by_reference = variance > 0 ? by_reference / variance : 0;
  }

  /// Rays are backward paths of one sample, on each side.
  void measure_gather(EstimatorPilot& one, const Reference& reference) const {
    SettingPilot& setting = one.settings.front();
    const auto samples = static_cast<double>(of_.scene_.samples.size());
    const double noise = reference.path_noise_squared;
    const auto judged = static_cast<double>(of_.judged_.samples.size());
    // noise_squared_error: of its mean at the judged samples, and of one run at all samples
    const double error = std::sqrt((2 / judged + 2 / samples) / static_cast<double>(runs + 1));
    setting.noise_squared_times_rays = {noise, noise * error};
    setting.bias_squared = reference.missed_squared;
    setting.mean_bias = {-reference.missed_mean, 0};
    setting.seconds = {of_.costs_.caster(), samples * of_.costs_.path(pilot_.casts_per_path), 0};
    one.runs = runs;
  }

  PilotMaker& of_;
  const AccuracyPilot* before_;
  AccuracyPilot pilot_;
  std::vector<double> relative_;
  PilotRadii radii_of_others_;
  std::size_t rays_of_run_;
  std::vector<sim::Paths> paths_;
  bool met_ = false;  ///< some photon met some sample
};

EstimatorPilot& AccuracyPilot::of(sim::Estimator estimator) {
  return *std::ranges::find(estimators, estimator, &EstimatorPilot::estimator);
}

const EstimatorPilot& AccuracyPilot::of(sim::Estimator estimator) const {
  return *std::ranges::find(estimators, estimator, &EstimatorPilot::estimator);
}

PilotMaker::PilotMaker(sim::Scene& scene, AccuracyPilotOptions options)
    : scene_(scene),
      options_(std::move(options)),
      maker_(scene, options_.front_facing, options_.threads, options_.stop),
      costs_(scene.mesh.triangles.size(), options_.threads),
      edge_(sim::mean_edge_length(scene.mesh, options_.stop)) {
  if (!(edge_ > 0))
    throw std::invalid_argument("accuracy needs a mesh with triangles; " + scene.name + " has none with edges");
  if (options_.radii.empty())
    for (const double share : radii_over_distance) options_.radii.push_back(share * edge_);
  judged_ = options_.reference != nullptr ? options_.reference->judged
                                          : judged_samples(scene, samples_judged, options_.weights);
  const ReferenceOptions judge{.seed = options_.seed,
                               .patch_radius = patch_over_edge * edge_,
                               .front_facing = options_.front_facing,
                               .threads = options_.threads,
                               .stop = options_.stop};
  judge_.emplace(scene, judged_, judge, maker_.caster());
}

PilotMaker::~PilotMaker() = default;

void PilotMaker::report(const char* doing) const {
  if (options_.progress) options_.progress({doing, 0, 1});
}

std::uint64_t PilotMaker::first_paths() const { return 64 * samples_judged / judged_.samples.size(); }

std::vector<EstimatorPilot> PilotMaker::settings_of(double rays_of_run) const {
  std::vector<EstimatorPilot> all;
  for (const sim::EstimatorRecord& record : sim::estimators) {
    const sim::Estimator estimator = record.estimator;
    if (!options_.estimators.empty() && std::ranges::find(options_.estimators, estimator) == options_.estimators.end())
      continue;
    EstimatorPilot& pilot = all.emplace_back(EstimatorPilot{.estimator = estimator, .settings = {}});
    const auto add = [&](const AccuracySetting& setting, double scale) {
      pilot.settings.push_back({.setting = setting, .scale = scale});
    };
    if (uses_radius(estimator))
      for (const double radius : options_.radii) add({estimator, radius}, radius);
    else if (estimator == sim::Estimator::nearest)
      for (const int k : nearest_of_run) add({.estimator = estimator, .nearest = k}, k / rays_of_run);
    else
      add({.estimator = estimator}, 1);
  }
  return all;
}

GrowingSeconds PilotMaker::seconds_of(const SettingPilot& setting, double judged_hits_per_ray) const {
  const auto samples = static_cast<double>(scene_.samples.size());
  const double share = samples / static_cast<double>(judged_.samples.size());
  return costs_.estimate(setting.setting.estimator, samples,
                         {share * judged_hits_per_ray, setting.setting.radius / edge_, setting.scale});
}

double PilotMaker::fixed_seconds() const {
  double surfaces = 0;  // the same for all estimators
  for (const EstimatorPilot& one : settings_of(1)) surfaces = std::max(surfaces, costs_.surfaces(one.estimator));
  return costs_.caster() + surfaces;
}

double PilotMaker::predicted_seconds(const PilotSize& size, const AccuracyPilot* before) const {
  constexpr double usual_casts_per_path = 5;
  const auto samples = static_cast<double>(judged_.samples.size());
  const double share = samples / static_cast<double>(scene_.samples.size());
  const double of_run = std::max(size.rays / runs, 1.0);
  double seconds = costs_.trace().per_ray * size.rays;
  const std::vector<EstimatorPilot> first = before != nullptr ? std::vector<EstimatorPilot>() : settings_of(of_run);
  for (const EstimatorPilot& one : before != nullptr ? before->estimators : first) {
    if (one.estimator == sim::Estimator::gather) continue;
    for (const SettingPilot& setting : one.settings) {
      if (setting.settled) continue;
      const GrowingSeconds all = before != nullptr ? setting.seconds : seconds_of(setting, 0);
      // fixed seconds, hits and neighbours are in proportion to the samples; other work for each ray is not
      const double of_surfaces = costs_.surfaces(one.estimator);
      const double none = costs_.estimate(one.estimator, 1, {}).per_ray;
      const double of_ray = none + std::max(0.0, all.per_ray - none) * share;
      const double times = sim::record_of(one.estimator).keeps_areas ? 1 : runs;
      seconds += times * (all.fixed - of_surfaces) * share + runs * of_ray * of_run;
    }
  }
  const double more = static_cast<double>(size.paths) / static_cast<double>(first_paths());
  const auto added = static_cast<double>(size.paths - std::min(size.paths, paths_made_));
  seconds += samples * added * costs_.path(before != nullptr ? before->casts_per_path : usual_casts_per_path);
  constexpr double pieces_followed = 3;  // of a photon for missed light: to the first surface, and some to the samples
  if (judge_->misses_light())
    seconds += more * first_photons_of_a_batch * batches_of_missed_light * pieces_followed * costs_.trace().per_ray;
  return seconds;
}

PilotSize PilotMaker::first_size() const {
  constexpr double fewest = 4000;
  PilotSize size{usual_pilot_rays, first_paths()};
  while (size.rays > fewest && predicted_seconds(size, nullptr) > share_of_pilots * options_.least_price)
    size.rays /= 1.25;
  return size;
}

AccuracyPilot PilotMaker::make(const PilotSize& size, const AccuracyPilot* before) {
  const sim::DefaultFloatingPoint mode;
  const sim::Stopwatch watch;
  Runs all(*this, size.rays, before);
  report("pilot: backward paths");
  judge_->add_paths(size.paths);
  paths_made_ = std::max(paths_made_, size.paths);
  const double more = static_cast<double>(size.paths) / static_cast<double>(first_paths());
  judge_->add_photons(static_cast<std::uint64_t>(more * first_photons_of_a_batch), batches_of_missed_light);
  const Reference& by_paths = judge_->reference();
  AccuracyPilot pilot = std::move(all).make(options_.reference != nullptr ? *options_.reference : by_paths, by_paths);
  pilot.seconds = watch.seconds();
  return pilot;
}

void escalate(PilotMaker& maker, AccuracyPilot& pilot, PilotSize size,
              const std::function<std::optional<PilotSize>(const PilotSize& made)>& next) {
  pilot = maker.make(size);
  while (const std::optional<PilotSize> wanted = next(size)) {
    size = *wanted;
    pilot = maker.make(size, &pilot);
  }
}

}  // namespace detp::validate
