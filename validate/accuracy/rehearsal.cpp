#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "accuracy_pilot.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/estimate/variable_radius.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t parts = 8;

constexpr std::uint64_t seed_of_part(std::uint64_t seed, std::size_t part) {
  return seed * 0x9e3779b97f4a7c15ULL + 104729 * (part + 1);
}

double scale_of(const AccuracySetting& setting) { return uses_radius(setting.estimator) ? setting.radius : 1; }

}  // namespace

/// What one part says of the samples.
struct PilotMaker::Part {
  std::vector<double> irradiance;
  std::vector<double> variance;  ///< of the irradiance
  double rays = 0;               ///< or backward paths at each sample

  /// Where one photon alone hit, or none, the variance is its own square.
  Part(sim::Outcome outcome, std::size_t searched)
      : irradiance(std::move(outcome.irradiance)), rays(static_cast<double>(searched)) {
    for (std::size_t i = 0; i < irradiance.size(); ++i)
      variance.push_back(std::pow(std::min(outcome.standard_error[i], irradiance[i]), 2));
  }
  Part(const std::vector<sim::PathSums>& sums, std::size_t paths) : rays(static_cast<double>(paths)) {
    for (const sim::PathSums& one : sums) {
      irradiance.push_back(one.irradiance());
      variance.push_back(one.variance());
    }
  }
};

/// Radii of variable-radius are those that the other half of the parts finds: as many of them as have sim::pilot_share of the answer's rays, or all.
std::vector<PilotMaker::Part> PilotMaker::parts_of(const AccuracySetting& setting, double rays,
                                                   const std::vector<std::size_t>& places, double answer_rays) {
  std::vector<sim::Sample> samples;
  std::vector<double> relative;
  for (const std::size_t place : places) {
    samples.push_back(scene_.samples[place]);
    if (!options_.relative.empty()) relative.push_back(options_.relative[place]);
  }
  const bool gathers = setting.estimator == sim::Estimator::gather;
  const std::size_t of_part = std::max<std::size_t>(gathers ? 2 : 200, static_cast<std::size_t>(rays / parts));
  std::vector<Part> all;
  std::vector<sim::TracedPaths> paths;
  double traced = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::uint64_t seed = seed_of_part(options_.seed, part);
    if (gathers) {
      all.emplace_back(maker_.gather(samples, of_part, seed), of_part);
    } else {
      paths.push_back(maker_.trace(of_part, seed, uses_radius(setting.estimator) ? setting.radius : 0));
      traced += static_cast<double>(paths.back().rays.size());
    }
  }
  if (gathers) return all;
  const bool varies = setting.estimator == sim::Estimator::variable_radius;
  const PilotRadii by_hits(scene_, places, judged_.population, options_.relative);
  const auto of_hits = static_cast<std::size_t>(
      std::clamp(std::round(sim::pilot_share * answer_rays / (traced / parts)), 1.0, static_cast<double>(parts) / 2));
  for (const std::size_t half : {std::size_t{0}, parts / 2}) {
    std::vector<std::uint64_t> hits;
    for (std::size_t i = 0; varies && i < of_hits; ++i) {
      const std::vector<std::uint64_t> found = by_hits.hits(maker_, paths[parts / 2 - half + i], setting.radius);
      hits.resize(found.size());
      std::ranges::transform(hits, found, hits.begin(), std::plus<>());
    }
    const std::vector<double> radii = varies ? by_hits.of(setting.radius, hits) : relative;
    const AccuracySetting of_parts = varies ? AccuracySetting{sim::Estimator::disc, setting.radius} : setting;
    for (std::size_t part = half; part < half + parts / 2; ++part)
      all.emplace_back(maker_.estimate(paths[part], samples, of_parts, true, radii), paths[part].rays.size());
  }
  return all;
}

std::optional<PilotMaker::RehearsalSize> PilotMaker::rehearsal_size(const AccuracyPilot& pilot,
                                                                    const AccuracySetting& setting, double most_rays,
                                                                    double seconds) const {
  constexpr std::size_t fewest_samples = 2000;
  constexpr double most_fixed = 0.4;  // of the seconds
  const sim::Estimator estimator = setting.estimator;
  if (estimator == sim::Estimator::nearest) return std::nullopt;
  const EstimatorPilot& own = pilot.of(estimator);
  const GrowingSeconds all = own.seconds(scale_of(setting));
  const bool gathers = estimator == sim::Estimator::gather;
  // areas, and what traces rays, are made once
  const double times = sim::record_of(estimator).keeps_areas ? 1 : gathers ? 0 : parts;
  const auto population = static_cast<double>(scene_.samples.size());
  RehearsalSize size{most_rays, judged_.population};
  const auto fixed = [&] {
    const double share = static_cast<double>(size.samples) / population;
    return times * share * (all.fixed - costs_.surfaces(estimator));
  };
  while (fixed() > most_fixed * seconds && size.samples > fewest_samples) size.samples /= 2;
  double least_rays = own.noise_rays;
  double per_ray = pilot.trace.per_ray + all.per_ray;
  if (gathers) {
    constexpr double fewest_paths = 2 * parts;
    least_rays = fewest_paths;
    const double of_sample = all.per_ray / population;
    while (fewest_paths * of_sample * static_cast<double>(size.samples) > seconds && size.samples > fewest_samples)
      size.samples /= 2;
    per_ray = of_sample * static_cast<double>(size.samples);
  }
  size.rays = std::min(most_rays, (seconds - fixed()) / per_ray);
  size.seconds = fixed() + size.rays * per_ray;
  if (size.rays < least_rays || size.samples < judged_.samples.size()) return std::nullopt;
  return size;
}

void PilotMaker::rehearse(AccuracyPilot& pilot, const AccuracySetting& setting, const RehearsalSize& size,
                          double answer_rays) {
  const sim::DefaultFloatingPoint mode;
  report("pilot: rehearsal");
  const JudgedSamples more = judged_samples(scene_, size.samples, options_.weights);
  std::vector<std::size_t> places;  // of both
  std::ranges::set_union(more.places, judged_.places, std::back_inserter(places));
  std::vector<double> noise;                   // square of a part's, without B²
  std::vector<double> squares(places.size());  // of the mean of all parts, without noise
  std::vector<double> means(places.size());
  const auto sum_over = [&](const JudgedSamples& some, const std::vector<double>& values) {
    double sum = 0;
    for (std::size_t i = 0, at = 0; i < some.places.size(); ++i) {
      while (places[at] != some.places[i]) ++at;
      sum += some.weights[i] * values[at];
    }
    return sum;
  };
  const std::vector<Part> made = parts_of(setting, size.rays, places, answer_rays);
  double rays = 0;
  for (const Part& part : made) {
    noise.push_back(sum_over(more, part.variance));
    rays += part.rays;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      means[i] += part.irradiance[i] / parts;
      squares[i] -= part.variance[i] / (parts * parts);
    }
  }
  std::vector<double> errors;  // square of a part's own error: few photons make that of one run large or small
  for (const Part& part : made) {
    std::vector<double> deviations(places.size());
    for (std::size_t i = 0; i < deviations.size(); ++i) deviations[i] = std::pow(part.irradiance[i] - means[i], 2);
    errors.push_back(sum_over(more, deviations));
  }
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += means[i] * means[i];
  // What the photons find at more samples and at those of the judge has the same blur: the ratio is that of what is true.
  const double all = sum_over(more, squares);
  const double at_judged = sum_over(judged_, squares);
  const Estimate found = batch_means(noise);
  EstimatorPilot& own = pilot.of(setting.estimator);
  const double scale = scale_of(setting);
  own.rehearsed = scale;
  if (!(all > 0 && at_judged > 0 && found.mean > 0)) return;  // too little light to know better
  const double mean_square = pilot.judged_square * all / at_judged;
  const double times_rays = found.mean / mean_square * rays / parts;
  const double ratio = times_rays / own.noise_squared(scale, 1);
  const double error = found.standard_error / found.mean;
  const Estimate of_errors = batch_means(errors);
  const double of_run = of_errors.mean > 0 ? std::sqrt(parts) * of_errors.standard_error / of_errors.mean : 0;
  const double both =
      std::hypot(error, of_run) / std::sqrt(static_cast<double>(own.runs) + 1);  // noise_squared_error()
  for (SettingPilot& one : own.settings) {
    const double changed = one.noise_squared_times_rays.mean * ratio;
    one.noise_squared_times_rays = {changed, changed * both};
    one.rare_photons = std::max(1.0, std::pow(std::max(error, 1e-4), -2));
  }
  own.noise_rays = rays;
  if (options_.reference == nullptr) pilot.mean_square = mean_square;  // else runs are compared at the judged samples
}

}  // namespace detp::validate
