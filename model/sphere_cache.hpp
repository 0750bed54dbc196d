#pragma once

#include <cstdint>
#include <vector>

#include "vocabulary.hpp"

/// The sphere cache with its exact walk, corrected.
///
/// What differs from the paper's account (sphere_cache_published.hpp):
///  - A sphere serves a disc only if the disc lies in it and in all larger ones; else rays are lost. So the walk goes
///    from the outermost sphere inwards, and rebuilds all from the first that does not hold the disc.
///  - m_i follows rebuild_law.hpp.
///  - S_i, centred where it was rebuilt, need not lie inside S_{i-1}. Its list then lacks rays of S_i that miss
///  S_{i-1}:
///    they are not needed by the discs it serves. The list is n_i times a share g_i < 1.
///  - Copying the lists and sorting the samples take time too.
///
///     T_R = t Σ_{i=1..k} m_i L_{i-1}      T_I = u n_P L_k      L_0 = n_R,  L_i = n_i g_i
///
///   where  n_i   expected rays in S_i: n_R P(hit S_i)
///          L_i   expected rays listed for S_i
namespace detp::model {

/// One sphere of the cache.
struct SphereLevel {
  std::int64_t i = 0;   ///< 1 … k, from the outside in
  double radius = 0;    ///< r_i, length
  double rays = 0;      ///< n_i: rays that cross S_i
  double listed = 0;    ///< L_i: rays in its list
  double rebuilds = 0;  ///< m_i
  double tests = 0;     ///< ray-sphere tests of one rebuild: L_{i-1}
};

/// g_i: share of the rays through S_i that its list holds, from the spheres around it.
///
///     g_i = √(Π_l h_l · min_l h_l)       h_l = c_l + (1 - c_l) H(r_i/r_l, (r_l - d)/r_l)
///
///   where  l     the six spheres around S_i, outwards
///          c_l   share of the rebuilds of S_i that also rebuild S_l, and so share its centre: m_l/m_i
///          H     both_hit_share averaged over a centre uniform in the disc of radius r_l - d
///
/// Were the shortfalls independent, their product would be right; were they nested, their minimum: it lies between.
/// `outwards` holds (r_l, m_l), nearest first. Source: our derivation and fit. Accuracy: of T_R as told at `counts`.
struct Enclosing {
  double radius;
  double rebuilds;
};
[[nodiscard]] double listed_share(const SphereLevel& sphere, const std::vector<Enclosing>& outwards, DiscRadius disc);

/// The first `most` of the k spheres. Throws std::invalid_argument for numbers out of range.
[[nodiscard]] std::vector<SphereLevel> sphere_levels(const Workload& workload, const SphereCacheParameters& parameters,
                                                     std::int64_t most);

/// Expected counts. Beyond 4096 spheres they are summed in groups of equal ratio.
///
/// Accuracy   counted on isotropic lines, samples uniform in a cube or on its faces, Q 0.3 … 0.8: T_R mostly within
///            10 %; see `detp validate`.
[[nodiscard]] Counts<double> sphere_cache_counts(const Workload& workload, const SphereCacheParameters& parameters);

}  // namespace detp::model
