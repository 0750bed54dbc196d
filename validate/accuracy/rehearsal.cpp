#include <algorithm>
#include <cmath>
#include <iterator>

#include "accuracy_pilot.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/estimate/variable_radius.hpp"

namespace detp::validate {
namespace {

constexpr std::size_t parts = 8;

/// What one part says of the samples.
struct Part {
  std::vector<double> irradiance;
  std::vector<double> variance;  ///< of the irradiance
};

/// Where one photon alone hit, or none, the variance is its own square.
Part part_of(sim::Outcome outcome) {
  Part part{std::move(outcome.irradiance), {}};
  part.variance.reserve(part.irradiance.size());
  for (std::size_t i = 0; i < part.irradiance.size(); ++i)
    part.variance.push_back(std::pow(std::min(outcome.standard_error[i], part.irradiance[i]), 2));
  return part;
}

Part part_of(const std::vector<sim::PathSums>& sums) {
  Part part;
  for (const sim::PathSums& one : sums) {
    part.irradiance.push_back(one.irradiance());
    part.variance.push_back(one.variance());
  }
  return part;
}

}  // namespace

/// Parts of a rehearsal.
class PilotMaker::Rehearsal {
 public:
  Rehearsal(PilotMaker& of, const AccuracySetting& setting, double rays, const std::vector<std::size_t>& places)
      : of_(of), setting_(setting), radii_(of.scene_, places, of.judged_.population, of.options_.relative) {
    for (const std::size_t place : places) {
      samples_.push_back(of.scene_.samples[place]);
      if (!of.options_.relative.empty()) relative_.push_back(of.options_.relative[place]);
    }
    of_part_ = std::max<std::size_t>(gathers() ? 2 : 200, static_cast<std::size_t>(rays / parts));
    for (std::size_t part = 0; !gathers() && part < parts; ++part)
      paths_.push_back(of.maker_.trace(of_part_, seed(part), uses_radius(setting.estimator) ? setting.radius : 0));
  }

  /// Or backward paths at each sample.
  [[nodiscard]] double rays() const {
    if (gathers()) return static_cast<double>(parts * of_part_);
    double count = 0;
    for (const sim::Paths& paths : paths_) count += static_cast<double>(paths.rays.size());
    return count;
  }

  /// Of each part. Radii of variable-radius are those that the other half of the parts finds.
  [[nodiscard]] std::vector<Part> all(double answer_rays) {
    const bool varies = setting_.estimator == sim::Estimator::variable_radius;
    std::vector<Part> all;
    for (std::size_t part = 0; gathers() && part < parts; ++part)
      all.push_back(part_of(of_.maker_.gather(samples_, of_part_, seed(part))));
    if (gathers()) return all;
    for (const std::size_t half : {0, 1}) {
      std::vector<double> found;
      if (varies) found = radii_by(1 - half, answer_rays);
      const std::span<const double> radii = varies ? std::span<const double>(found) : relative_;
      for (std::size_t part = half * parts / 2; part < (half + 1) * parts / 2; ++part)
        all.push_back(part_of(of_.maker_.estimate(paths_[part], samples_, varies ? plain() : setting_, true, radii)));
    }
    return all;
  }

 private:
  [[nodiscard]] bool gathers() const { return setting_.estimator == sim::Estimator::gather; }
  [[nodiscard]] std::uint64_t seed(std::size_t part) const {
    return of_.options_.seed * 0x9e3779b97f4a7c15ULL + 104729 * (part + 1);
  }
  [[nodiscard]] AccuracySetting plain() const { return {sim::Estimator::disc, setting_.radius}; }

  /// By as many parts of a half as have sim::pilot_share of the answer's rays, or by all of them.
  [[nodiscard]] std::vector<double> radii_by(std::size_t half, double answer_rays) const {
    const double of_part = rays() / parts;
    const auto count = static_cast<std::size_t>(
        std::clamp(std::round(sim::pilot_share * answer_rays / of_part), 1.0, static_cast<double>(parts) / 2));
    std::vector<std::uint64_t> hits;
    for (std::size_t part = half * parts / 2; part < half * parts / 2 + count; ++part) {
      const std::vector<std::uint64_t> found = radii_.hits(of_.maker_, paths_[part], setting_.radius);
      hits.resize(found.size());
      for (std::size_t i = 0; i < hits.size(); ++i) hits[i] += found[i];
    }
    return radii_.of(setting_.radius, hits);
  }

  PilotMaker& of_;
  AccuracySetting setting_;
  std::vector<sim::Sample> samples_;
  std::vector<double> relative_;
  PilotRadii radii_;
  std::size_t of_part_ = 0;  ///< rays, or backward paths
  std::vector<sim::TracedPaths> paths_;
};

bool PilotMaker::can_rehearse(sim::Estimator estimator) { return estimator != sim::Estimator::nearest; }

std::optional<PilotMaker::RehearsalSize> PilotMaker::rehearsal_size(const AccuracyPilot& pilot,
                                                                    sim::Estimator estimator, double scale,
                                                                    double most_rays, double seconds) const {
  constexpr std::size_t fewest_samples = 2000;
  constexpr double most_fixed = 0.4;  // of the seconds
  const EstimatorPilot& own = pilot.of(estimator);
  const GrowingSeconds all = own.seconds(scale);
  // areas, and what traces rays, are made once
  const double times = estimator == sim::Estimator::area_corrected ? 1
                       : estimator == sim::Estimator::gather       ? 0
                                                                   : parts;
  const auto population = static_cast<double>(scene_.samples.size());
  RehearsalSize size{most_rays, judged_.population};
  const auto fixed = [&] {
    const double share = static_cast<double>(size.samples) / population;
    return times * share * (all.fixed - costs_.surfaces(estimator));
  };
  while (fixed() > most_fixed * seconds && size.samples > fewest_samples) size.samples /= 2;
  double least_rays = own.noise_rays;
  double per_ray = pilot.trace.per_ray + all.per_ray;
  if (estimator == sim::Estimator::gather) {
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

void PilotMaker::rehearse(AccuracyPilot& pilot, const AccuracySetting& setting, double scale, const RehearsalSize& size,
                          double answer_rays) {
  const sim::DefaultFloatingPoint mode;
  report("pilot: rehearsal");
  const JudgedSamples more = judged_samples(scene_, size.samples, options_.weights);
  std::vector<std::size_t> places;  // of both
  std::ranges::set_union(more.places, judged_.places, std::back_inserter(places));
  Rehearsal rehearsal(*this, setting, size.rays, places);
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
  const std::vector<Part> made = rehearsal.all(answer_rays);
  for (const Part& part : made) {
    noise.push_back(sum_over(more, part.variance));
    for (std::size_t i = 0; i < squares.size(); ++i) {
      means[i] += part.irradiance[i] / parts;
      squares[i] -= part.variance[i] / (parts * parts);
    }
  }
  std::vector<double>
      errors;  // square of a part's own error, which is that of one run: few photons make it large or small
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
  own.rehearsed = scale;
  if (!(all > 0 && at_judged > 0 && found.mean > 0)) return;  // too little light to know better
  const double mean_square = pilot.judged_square * all / at_judged;
  const double times_rays = found.mean / mean_square * rehearsal.rays() / parts;
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
  own.noise_rays = rehearsal.rays();
  if (options_.reference == nullptr) pilot.mean_square = mean_square;  // else runs are compared at the judged samples
}

}  // namespace detp::validate
