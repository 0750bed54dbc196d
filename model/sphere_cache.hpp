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

/// A sphere around S_i.
struct Enclosing {
  double radius = 0;    ///< r_l, length
  double rebuilds = 0;  ///< m_l; 0 for S₀, which stays where it is
  double reach = 0;     ///< radius of the disc over which the offset of S_i's centre from its own spreads, length
};

/// g_i: share of the rays through S_i that its list holds: of those that also cross the spheres around it. S₀ is one of
/// them: a sphere near the rim of the scene pokes out of it.
///
///     g_i = √(Π_l h_l · min_l h_l)       h_l = c_l + (1 - c_l) H(r_i/r_l, reach_l/r_l)
///
///   where  l     S₀ and the next spheres around S_i, six in all
///          c_l   share of the rebuilds of S_i that also rebuild S_l, and so share its centre: m_l/m_i
///          H     both_hit_share averaged over a centre uniform in the disc of radius reach_l
///   reach_l      r_l - d; for S₀ √2 times the root mean square distance of the samples from its centre
///
/// Were the shortfalls independent, their product would be right; were they nested, their minimum: it lies between.
/// `outwards` holds the nearest first. Source: our derivation and fit. Accuracy: of T_R as told at
/// `sphere_cache_counts`.
[[nodiscard]] double listed_share(const SphereLevel& sphere, const std::vector<Enclosing>& outwards);

/// The first `most` of the k spheres. Throws std::invalid_argument for numbers out of range.
[[nodiscard]] std::vector<SphereLevel> sphere_levels(const Workload& workload, const SphereCacheParameters& parameters,
                                                     std::int64_t most);

/// Expected counts. Beyond 4096 spheres they are summed in groups of equal ratio.
///
/// Accuracy   against structural_walk of validate, samples uniform in a cube or on its faces, n_P 10³ … 10⁶, d/r₀ 10⁻⁴
/// …
///            0.2, Q 0.3 … 0.9 (200 workloads): T_R within 2.2 % in the median, 13 % at worst (Q = 0.9); m_i (3551
///            spheres with at least 30 rebuilds) within 0.8 % in the median, 7 % at the 95th percentile, 25 % at worst
///            (Q = 0.9).
[[nodiscard]] Counts<double> sphere_cache_counts(const Workload& workload, const SphereCacheParameters& parameters);

}  // namespace detp::model
