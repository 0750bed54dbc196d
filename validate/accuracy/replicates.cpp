#include "replicates.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/base/stopwatch.hpp"
#include "detp/sim/base/threads.hpp"
#include "detp/sim/effects/all_effects.hpp"
#include "detp/sim/effects/observe.hpp"
#include "detp/sim/effects/self_shadow.hpp"
#include "detp/sim/estimate/surface.hpp"
#include "detp/sim/estimate/variable_radius.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "judged_samples.hpp"

namespace detp::validate {
namespace {

/// A box tree of a usual shape: all exact techniques find the same pairs.
const Candidate usual_search{Technique::box_tree, BoxTreeParameters{8, 16}};

}  // namespace

ReplicateMaker::ReplicateMaker(sim::Scene& scene, bool front_facing, int threads, std::stop_token stop)
    : scene_(scene), front_facing_(front_facing), threads_(threads), stop_(std::move(stop)) {
  const sim::Stopwatch watch;
  caster_ = sim::caster_for(scene, stop_);
  caster_seconds_ = watch.seconds();
}

bool ReplicateMaker::goes_on() {
  if (!goes_on_) {
    const sim::Finding shadow = sim::self_shadow(scene_, caster_, front_facing_, stop_).finding;
    goes_on_ = sim::EffectSelection{}.is_on(sim::concave_surfaces, shadow.value, shadow.standard_error);
  }
  return *goes_on_;
}

double ReplicateMaker::overshoot(double radius) {
  return radius > 0 && goes_on() ? sim::overshoot_over_radius * radius : 0;
}

sim::TracedPaths ReplicateMaker::trace(std::size_t rays, std::uint64_t seed, double radius) {
  scene_.overshoot = overshoot(radius);
  return sim::photon_paths(scene_, rays, seed, caster_, stop_);
}

sim::Outcome ReplicateMaker::estimate(const sim::PathRays& paths, std::span<const sim::Sample> samples,
                                      const AccuracySetting& setting, bool standard_error,
                                      std::span<const double> relative) const {
  const auto discs = discs_at(samples, uses_radius(setting.estimator) ? setting.radius : 1, relative);
  const sim::Problem problem = sim::make_problem(paths, discs, front_facing_, sim::thread_count(threads_), stop_);
  const sim::RunOptions options{.count = false, .standard_error = standard_error, .stop = stop_, .threads = threads_};
  sim::Outcome outcome =
      sim::record_of(setting.estimator).needs_mesh()
          ? sim::run(problem, surfaces(setting.estimator), options)
          : sim::estimate(problem,
                          {.estimator = setting.estimator, .candidate = usual_search, .nearest = setting.nearest},
                          options);
  if (outcome.stopped) throw sim::Stopped("stopped during a run");
  return outcome;
}

std::vector<sim::PathSums> ReplicateMaker::gather(std::span<const sim::Sample> samples, std::uint64_t paths,
                                                  std::uint64_t seed) const {
  const sim::BackwardPaths walk(scene_, seed, caster_);
  std::vector<sim::PathSums> sums(samples.size());
  sim::on_threads(sim::thread_count(threads_),
                  [&] { sim::add_backward_paths(walk, samples, paths, front_facing_, sums, stop_); });
  if (stop_.stop_requested()) throw sim::Stopped("stopped during a run");
  return sums;
}

const sim::Index& ReplicateMaker::surfaces(sim::Estimator estimator) const {
  std::unique_ptr<const sim::Index>& built = surfaces_[static_cast<std::size_t>(estimator)];
  if (triangles_ == nullptr) triangles_ = std::make_shared<const sim::NearTriangles>(scene_.mesh, stop_);
  if (built == nullptr) built = sim::prepare_surfaces(estimator, scene_.mesh, stop_, triangles_);
  return *built;
}

PilotRadii::PilotRadii(const sim::Scene& scene, std::span<const std::size_t> places, std::size_t population,
                       std::span<const double> relative)
    : counting_(places.size()) {
  constexpr std::size_t most_for_median = 1000;
  std::vector<std::size_t> all(places.begin(), places.end());
  if (population < scene.samples.size()) {
    const std::vector<double> equal(scene.samples.size(), 1.0);
    const JudgedSamples everywhere = judged_samples(scene, most_for_median, equal);
    all.insert(all.end(), everywhere.places.begin(), everywhere.places.end());
  }
  for (const std::size_t place : all) {
    samples_.push_back(scene.samples[place]);
    if (!relative.empty()) relative_.push_back(relative[place]);
  }
}

std::vector<std::uint64_t> PilotRadii::hits(const ReplicateMaker& maker, const sim::PathRays& paths,
                                            double radius) const {
  return maker.estimate(paths, samples_, {sim::Estimator::disc, radius}, false, relative_).hits;
}

std::vector<double> PilotRadii::of(double radius, std::span<const std::uint64_t> hits) const {
  const bool all_count = counting_ == samples_.size();
  const std::uint64_t usual = sim::usual_hits(all_count ? hits : hits.subspan(counting_));
  const std::vector<sim::Disc> discs =
      discs_at(std::span(samples_).first(counting_), radius,
               relative_.empty() ? std::span<const double>() : std::span(relative_).first(counting_));
  std::vector<double> found;
  for (const sim::Disc& disc : sim::discs_of_pilot(discs, hits.first(counting_), usual))
    found.push_back(disc.radius / radius);
  return found;
}

sim::PathRays first_photons(const sim::Paths& paths, std::uint64_t photons) {
  const auto rays = static_cast<std::size_t>(std::ranges::lower_bound(paths.photons, photons) - paths.photons.begin());
  const sim::PathRays all = paths;
  return {all.rays.first(rays), all.photons.first(rays), all.landings.first(rays), photons, all.triangles.first(rays)};
}

std::vector<sim::Disc> discs_at(std::span<const sim::Sample> samples, double radius, std::span<const double> relative) {
  std::vector<sim::Disc> discs;
  discs.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    discs.push_back({samples[i].position, samples[i].normal, relative.empty() ? radius : radius * relative[i]});
  return discs;
}

std::vector<sim::Ray> with_overshoot(const sim::Paths& paths, const sim::Scene& scene, double overshoot) {
  const double beyond = std::max(overshoot, sim::PhotonWalk::gap_share * glm::length(scene.box.size()));
  std::vector<sim::Ray> rays = paths.rays;
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].length = std::min(rays[i].length, paths.landings[i] + beyond);
  return rays;
}

}  // namespace detp::validate
