#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The sphere cache with its exact walk, corrected.
///
/// Differences from the paper's version (sphere_cache_published.hpp):
///  - A sphere serves a disc only if this sphere and all larger spheres contain the disc; otherwise rays would be lost.
///    So the walk goes inwards, and rebuilds all spheres from the first one that does not contain the disc.
///  - m_i follows rebuild_law.hpp.
///  - S_i is centred where it was rebuilt and need not lie inside S_{i-1}, so its list holds only a share of its rays
///    (listed_rays.hpp).
///  - Copying the lists and sorting the samples take time too.
///
///     T_R = t Σ_{i=1..k} m_i L'_{i-1}      T_I = u n_P L"_k      L_0 = L'_0 = n_R,  L_i = n_i g_i
///     L'_i = L_i [1 + 0.6 c (1-c) (1-g_i)]    c = m_i/m_{i+1}
///     L"_k = L_k [1 + 0.25 (1-c) (1-g_k)]     c = m_k/n_P
///
///   where  t, u, m_i, n_R, n_P, T_R, T_I as in sphere_cache_published.hpp
///          n_i   expected rays in S_i: n_R P(hit S_i)
///          L_i   expected rays listed for S_i, mean over its builds;   g_i   listed_share
///          L'_i  length of that list, mean over the builds of S_{i+1};   L"_k   mean over the discs. Both exceed L, by
///                at most 4 % and 8 %, because long lists are used for longer than short ones. 0.6 and 0.25 are fitted
///                to counted walks
namespace detp::model {

/// One sphere of the cache.
struct SphereLevel {
  std::int64_t i = 0;   ///< 1 … k, from the outside in
  double radius = 0;    ///< r_i, length
  double rays = 0;      ///< n_i: rays that cross S_i
  double listed = 0;    ///< L_i: rays in its list
  double rebuilds = 0;  ///< m_i
  double tests = 0;     ///< ray-sphere tests of one rebuild: L'_{i-1}
  double served = 0;    ///< L"_i: ray-disc tests of a disc if S_i is the innermost sphere
};

/// The spheres S_1 … S_j, j = min(most, k). Throws std::invalid_argument for numbers out of range, and for the Hilbert
/// order (require_rebuild_law).
[[nodiscard]] std::vector<SphereLevel> sphere_levels(const Valid<Workload>& workload,
                                                     const Valid<SphereCacheParameters>& parameters, std::int64_t most);

/// Calls visit with S_1 … S_k from the outside in, until visit returns false.
void for_each_level(const Valid<Workload>& workload, const Valid<SphereCacheParameters>& parameters,
                    const std::function<bool(const SphereLevel&)>& visit);

/// Expected counts, in bounded time for any k (0: each disc is tested with all rays). More than 4096 spheres are summed
/// in groups. In a group, s_i w_i/n of the rebuild law is taken as constant, so n - m_i shrinks by the same factor at
/// each sphere. The ratio of consecutive terms m_i L'_{i-1} is taken as constant too, so the sums have a closed form.
/// Spheres with r_i < d, which are rebuilt for each sample, have groups of their own.
///
/// Accuracy   compared with walks counted over samples uniform in a cube (D = 3) or on its faces (D = 2), n_P
///            10³ … 10⁷, d/r₀ 10⁻⁴ … 0.2, Q 0.3 … 0.9: 250 workloads, means over 1000 (n_P = 10³) to 2 (10⁷) sets of
///            samples, 4463 spheres with at least 30 rebuilds. Deviations (median, 95th percentile, largest):
///              m_i   0.4, 3.1, 9.4 % (D = 2; largest at n_P = 10⁷, Q = 0.8) and 0.1, 2.0, 7.9 % (D = 3; 10⁷, 0.9)
///              L_i   0.3, 1.6, 6.4 % (D = 2) and 0.2, 1.8, 5.3 % (D = 3), the largest at n_P = 10⁷, where the count
///                    has up to 3 % of noise; for n_P up to 10⁶ the largest are 3.2 and 2.9 %
///              T_R   0.7, 1.7, 2.6 % (D = 2) and 0.4, 1.3, 2.3 % (D = 3)
///            T_I, with the innermost sphere at r_k = 0.3 or 0.1 r₀ (32 workloads): within 5.4 % (surfaces, one
///            sphere), mostly within 2 %. Groups compared with the sum over all spheres, k 4097 … 10⁶, n_P 10³ … 10⁹,
///            d/r₀ 10⁻⁶ … 0.5: 0.2 %.
[[nodiscard]] Counts<double> sphere_cache_counts(const Valid<Workload>& workload,
                                                 const Valid<SphereCacheParameters>& parameters);

}  // namespace detp::model
