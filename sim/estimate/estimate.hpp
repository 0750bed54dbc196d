#pragma once

#include "detp/sim/technique/technique.hpp"
#include "estimator.hpp"
#include "gather.hpp"

/// Estimates the irradiance at the samples of a problem's discs.
namespace detp::sim {

struct EstimateRequest {
  Estimator estimator = Estimator::disc;
  /// Of disc and variable-radius: the exact technique that finds the pairs.
  Candidate candidate = {Technique::brute_force, BruteForceParameters{}};
  int nearest = 50;  ///< of nearest: k, as PhotonMapParameters
  NearestForm nearest_form = NearestForm::unbiased;
  /// Of area-corrected and triangle-hits: the mesh in which the photon paths were traced.
  const Mesh* mesh = nullptr;
  /// Of gather: the scene, and how many backward paths start at each disc, on each side that counts.
  const Scene* scene = nullptr;
  std::uint64_t paths = paths_by_default;
  std::uint64_t seed = 1;
};

/// The irradiance by any estimator, in an outcome as `run` has: hits are the rays, photons or backward paths that count for a disc. Standard
/// errors and bounds, if requested, are those of whole photons (irradiance.hpp), or of backward paths (gather.hpp). Results do not depend on the number of threads.
///
/// Throws as `run`; std::invalid_argument if the estimator needs what there is not: nearest, area-corrected and triangle-hits
/// need photons that met a surface, area-corrected and triangle-hits a mesh, triangle-hits the triangles that the photons met
/// (PathRays::triangles), variable-radius two photons, gather a scene with triangles and light (of the problem only its discs); for options that the estimator does not have (pairs and totals: disc
/// alone; pairs: also nearest). Does not throw Stopped: if a stop was requested, the outcome has `stopped` set and is partial.
[[nodiscard]] Outcome estimate(const Problem& problem, const EstimateRequest& request, const RunOptions& options = {});

}  // namespace detp::sim
