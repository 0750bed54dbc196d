#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/geometry/paths.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/ray_caster.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/scene/near_triangles.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/search/index.hpp"

/// Runs of one setting with their own seeds: the spread is the noise.
namespace detp::validate {

/// An estimator, and what it is set to.
struct AccuracySetting {
  sim::Estimator estimator = sim::Estimator::disc;
  double radius = 0;  ///< of the discs, scene units; not used by nearest and triangle-hits
  int nearest = 50;   ///< of nearest: k
};

/// Whether the radius matters to the estimator.
[[nodiscard]] constexpr bool uses_radius(sim::Estimator estimator) { return sim::record_of(estimator).uses_radius; }

/// Makes photon paths of a scene and estimates from them, as `detp run` does. The scene must outlive this; its overshoot is set.
class ReplicateMaker {
 public:
  /// `front_facing`: light that arrives from behind does not count.
  ReplicateMaker(sim::Scene& scene, bool front_facing, int threads, std::stop_token stop = {});

  /// Decides whether paths go on beyond surfaces (trace), so that tracing does not take the time for it.
  void decide_overshoot() { static_cast<void>(goes_on()); }

  /// Seconds that building the mesh's ray caster took.
  [[nodiscard]] double caster_seconds() const { return caster_seconds_; }
  [[nodiscard]] const std::shared_ptr<const sim::RayCaster>& caster() const { return caster_; }

  /// At least so many pieces of paths. `radius` says how far they go on beyond the surfaces where they end, if the discs of this
  /// radius would shadow themselves otherwise (sim/effects/self_shadow.hpp); 0: not at all.
  [[nodiscard]] sim::TracedPaths trace(std::size_t rays, std::uint64_t seed, double radius);

  /// `relative`: radii of the discs over the setting's; none: 1. Throws as sim::estimate; sim::Stopped if a stop request came.
  [[nodiscard]] sim::Outcome estimate(const sim::PathRays& paths, std::span<const sim::Sample> samples,
                                      const AccuracySetting& setting, bool standard_error = false,
                                      std::span<const double> relative = {}) const;

  /// Sums of so many backward paths at each sample, on each side. Throws as sim::BackwardPaths; sim::Stopped if a stop request came.
  [[nodiscard]] std::vector<sim::PathSums> gather(std::span<const sim::Sample> samples, std::uint64_t paths,
                                                  std::uint64_t seed) const;

  /// Overshoot of paths for discs of this radius.
  [[nodiscard]] double overshoot(double radius);

 private:
  [[nodiscard]] bool goes_on();
  [[nodiscard]] const sim::Index& surfaces(sim::Estimator estimator) const;

  sim::Scene& scene_;
  bool front_facing_;
  int threads_;
  std::stop_token stop_;
  std::shared_ptr<const sim::RayCaster> caster_;
  double caster_seconds_ = 0;
  /// Built once, they depend on the mesh alone.
  mutable std::shared_ptr<const sim::NearTriangles> triangles_;
  mutable std::array<std::unique_ptr<const sim::Index>, sim::estimators.size()> surfaces_;
  std::optional<bool> goes_on_;  ///< paths go on beyond surfaces
};

/// Radii of variable-radius at some of a scene's samples, from the hits of other runs: a tenth of so short a run would not find the radii of a long
/// one. The median of the hits is that of discs at all samples of the scene, as in a run.
class PilotRadii {
 public:
  /// `places`: of samples that count, or of a random part of `population` such samples, rising. `relative`: radii of the scene's samples over the
  /// setting's; none: 1.
  PilotRadii(const sim::Scene& scene, std::span<const std::size_t> places, std::size_t population,
             std::span<const double> relative);

  /// Of discs, everywhere where they are needed.
  [[nodiscard]] std::vector<std::uint64_t> hits(const ReplicateMaker& maker, const sim::PathRays& paths,
                                                double radius) const;

  /// Radii over `radius` at the samples that count (sim::discs_of_pilot), from the hits of such discs.
  [[nodiscard]] std::vector<double> of(double radius, std::span<const std::uint64_t> hits) const;

 private:
  std::size_t counting_;
  std::vector<sim::Sample> samples_;  ///< those that count come first
  std::vector<double> relative_;
};

/// The rays of the first photons. Each photon still has the power that it has among all.
[[nodiscard]] sim::PathRays first_photons(const sim::Paths& paths, std::uint64_t photons);

/// Discs at samples, of one radius, or of radii relative to it.
[[nodiscard]] std::vector<sim::Disc> discs_at(std::span<const sim::Sample> samples, double radius,
                                              std::span<const double> relative = {});

/// The rays with an overshoot (Scene::overshoot) that is at most that with which they were traced: as if they had been traced with it.
[[nodiscard]] std::vector<sim::Ray> with_overshoot(const sim::Paths& paths, const sim::Scene& scene, double overshoot);

}  // namespace detp::validate
