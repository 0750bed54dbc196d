#include "reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "detp/model/vocabulary/checks.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/estimate/surface.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/reference/missed_light.hpp"
#include "replicates.hpp"

namespace detp::validate {
namespace {

constexpr std::uint64_t paths_at_first = 64;
constexpr std::uint64_t most_paths = 1 << 22;
constexpr std::uint64_t photons_of_a_batch = 1 << 20;
constexpr int fewest_batches = 4;
constexpr int most_batches = 1024;

double square_of_number(double x) { return x * x; }

void require_in_range(const ReferenceOptions& options) {
  require_count("number of samples of a reference", static_cast<double>(options.samples), 1, 1e7);
  require_positive("error of a reference", options.error);
  require_positive("seconds of a reference", options.seconds);
  require_non_negative("radius of the reference's patches", options.patch_radius);
}

/// Mean of the batches and its variance, at one sample.
Estimate over_batches(const std::vector<std::vector<double>>& batches, std::size_t sample) {
  const auto count = static_cast<double>(batches.size());
  double sum = 0;
  for (const auto& batch : batches) sum += batch[sample];
  const double mean = sum / count;
  double squares = 0;
  for (const auto& batch : batches) squares += square_of_number(batch[sample] - mean);
  return {mean, std::sqrt(squares / count / (count - 1))};
}

}  // namespace

std::string_view name(ReferenceKind kind) {
  switch (kind) {
    case ReferenceKind::known:
      return "known";
    case ReferenceKind::backward:
      return "backward paths";
    case ReferenceKind::both:
      return "backward paths and photons";
  }
  return "";
}

double Reference::mean_square() const {
  double square = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i)
    square += judged.weights[i] * (square_of_number(irradiance[i]) - variance[i]);
  return square;
}

double Reference::error() const {
  double errors = 0;
  for (std::size_t i = 0; i < irradiance.size(); ++i) errors += judged.weights[i] * variance[i];
  return errors > 0 ? std::sqrt(errors / std::max(mean_square(), 1e-300)) : 0;
}

ReferenceMaker::ReferenceMaker(const sim::Scene& scene, JudgedSamples judged, const ReferenceOptions& options,
                               std::shared_ptr<const sim::RayCaster> caster)
    : scene_(scene),
      options_(options),
      caster_(caster ? std::move(caster) : sim::caster_for(scene, options.stop)),
      walk_(scene, options.seed, caster_),
      misses_light_(sim::misses_light(scene)),
      sums_(judged.samples.size()) {
  reference_.scene = scene.name;
  reference_.kind = misses_light_ ? ReferenceKind::both : ReferenceKind::backward;
  reference_.judged = std::move(judged);
}

void ReferenceMaker::add_paths(std::uint64_t paths) {
  const sim::Stopwatch watch;
  sim::on_threads(sim::thread_count(options_.threads), [&] {
    sim::add_backward_paths(walk_, reference_.judged.samples, paths, options_.front_facing, sums_, options_.stop);
  });
  if (options_.stop.stop_requested() && std::ranges::any_of(sums_, [](const auto& one) { return one.paths < 2; }))
    throw sim::Stopped("stopped before the reference had a value for each sample");
  reference_.seconds += watch.seconds();
}

void ReferenceMaker::add_photons(std::uint64_t photons, int batches) {
  if (!misses_light_) return;
  const sim::Stopwatch watch;
  if (missed_.empty())
    missed_bound_ = sim::missed_share(scene_, caster_, options_.seed, sim::photons_of_share, options_.stop).upper_bound;
  if (photons > photons_of_batch_) missed_.clear();  // smaller batches would add their noise
  photons_of_batch_ = photons;
  for (int i = 0; i < batches; ++i) missed_.push_back(missed_by_photons(photons));
  reference_.seconds += watch.seconds();
}

std::vector<double> ReferenceMaker::missed_by_photons(std::uint64_t photons) {
  // apart from the seeds of the runs that are judged
  const std::uint64_t seed = (options_.seed << 20) + (std::uint64_t{1} << 63) + batches_made_++;
  sim::Paths missed;
  sim::on_threads(sim::thread_count(options_.threads),
                  [&] { missed = sim::missed_light(scene_, caster_, seed, photons, options_.stop); });
  reference_.photons += photons;
  const double radius =
      options_.patch_radius > 0 ? options_.patch_radius : sim::mean_edge_length(scene_.mesh, options_.stop) / 8;
  std::vector<double> found = within(missed, radius);
  const std::vector<double> wider = within(missed, 2 * radius);
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = 2 * found[i] - wider[i];
  return found;
}

std::vector<double> ReferenceMaker::within(const sim::Paths& missed, double radius) {
  if (missed.rays.empty()) return std::vector<double>(sums_.size());
  const auto discs = discs_at(reference_.judged.samples, radius);
  const sim::Problem problem =
      sim::make_problem(missed, discs, options_.front_facing, sim::thread_count(options_.threads), options_.stop);
  if (!surfaces_) surfaces_ = sim::prepare_area_corrected(scene_.mesh, options_.stop);
  sim::Outcome outcome =
      sim::run(problem, *surfaces_, {.count = false, .stop = options_.stop, .threads = options_.threads});
  if (outcome.stopped) throw sim::Stopped("stopped before the reference had a value for each sample");
  return std::move(outcome.irradiance);
}

const Reference& ReferenceMaker::reference() {
  const std::size_t samples = sums_.size();
  reference_.irradiance.resize(samples);
  reference_.variance.resize(samples);
  reference_.paths = sums_.front().paths;
  const std::vector<double>& weights = reference_.judged.weights;
  double of_path = 0;
  double casts = 0;
  double missed_square = 0;
  double missed_variance = 0;
  double missed = 0;
  double mean = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const Estimate by_photons = misses_light_ ? over_batches(missed_, i) : Estimate{};
    const double variance = square_of_number(by_photons.standard_error);
    reference_.irradiance[i] = sums_[i].irradiance() + by_photons.mean;
    reference_.variance[i] = sums_[i].variance() + variance;
    reference_.paths = std::min(reference_.paths, sums_[i].paths);
    casts += static_cast<double>(sums_[i].casts) / static_cast<double>(sums_[i].paths * samples);
    of_path += weights[i] * sums_[i].variance() * static_cast<double>(sums_[i].paths);
    const double square = square_of_number(by_photons.mean) - variance;
    missed_square += weights[i] * square;
    missed_variance +=
        square_of_number(weights[i]) * (4 * std::max(0.0, square) * variance + 2 * square_of_number(variance));
    missed += weights[i] * by_photons.mean;
    mean += weights[i] * reference_.irradiance[i];
  }
  reference_.casts_per_path = casts;
  const double square = reference_.mean_square();
  if (square > 0) {
    // light that no photon brought to the samples is bounded, not absent
    const double error = std::max(std::sqrt(missed_variance) / square, square_of_number(missed_bound_));
    reference_.missed_squared = {missed_square / square, error};
    reference_.path_noise_squared = of_path / square;
  }
  if (mean > 0) reference_.missed_mean = missed / mean;
  return reference_;
}

Reference make_reference(const sim::Scene& scene, const ReferenceOptions& options) {
  const sim::DefaultFloatingPoint mode;
  require_in_range(options);
  if (scene.samples.empty() || scene.mesh.triangles.empty())
    throw std::invalid_argument("a reference needs samples and triangles; " + scene.name + " has none");
  const sim::Stopwatch watch;
  JudgedSamples judged = judged_samples(scene, options.samples);
  if (scene.known_irradiance) {
    Reference known{.scene = scene.name, .judged = std::move(judged), .irradiance = {}, .variance = {}};
    known.irradiance.assign(known.judged.samples.size(), *scene.known_irradiance);
    known.variance.assign(known.judged.samples.size(), 0);
    return known;
  }
  ReferenceMaker maker(scene, std::move(judged), options);
  maker.add_photons(photons_of_a_batch, fewest_batches);
  std::uint64_t paths = paths_at_first;
  for (int batches = fewest_batches;; ++batches) {
    maker.add_paths(paths);
    const Reference& reference = maker.reference();
    const double error = reference.error();
    const bool over = options.stop.stop_requested() || watch.seconds() >= options.seconds;
    if (error <= options.error || over || paths >= most_paths || batches >= most_batches) {
      Reference made = reference;
      made.stopped = error > options.error;
      return made;
    }
    if (options.progress) {
      const double done = std::max(square_of_number(options.error / error), watch.seconds() / options.seconds);
      options.progress({fmt::format("reference: {}", name(reference.kind)), std::min(1.0, done), 1});
    }
    if (!maker.misses_light() || reference.paths < static_cast<std::uint64_t>(batches) * paths_at_first)
      paths += paths / 2;
    maker.add_photons(photons_of_a_batch, 1);
  }
}

}  // namespace detp::validate
