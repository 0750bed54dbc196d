#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The number of rays of a sphere of the cache: n_i rays cross it, L_i are in its list.
///
/// S_i is centred at the sample for which it was rebuilt. The spheres around it were centred at this sample or at an
/// earlier one, so S_i may extend outside them, and outside S₀ near the edge of the scene. Rays that cross S_i but miss
/// one of the spheres around it are not listed (the discs that S_i serves do not need them). So L_i = n_i g_i with
/// a share g_i <= 1.
namespace detp::model {

/// n_i: rays that cross a sphere of radius r inside S₀.
///
///     n_i = n_R r²/r₀²                   lines
///     n_i = n_R (V + ℓF/4)/V_box         segments of mean length ℓ; V and F are volume and surface of the sphere
///
/// Exact if the sphere lies in S₀ and the rays are uniform. If the sphere extends outside S₀, n_i is too large; the
/// factor g_i corrects this.
[[nodiscard]] double rays_through(const Valid<Workload>& workload, double radius);

/// g_i along the Morton curve: share of the rays through S_i that cross all spheres around it, mean over its builds.
///
///     1 - g = deep(λ, u, d/r_i) + [shallow(r₀/r_i, u, d/r₀) - deep(λ', u, d/r_i)]
///
///   where  deep      share lost far inside S₀
///          shallow   share lost near S₀, where S_i extends outside S₀, and fewer spheres are around S_i
///          λ         samples in a cube of side r_i, n_P r_i^D/extent;   u   log₂(1/Q)
///          λ'        λ of the samples with which `shallow` was tabulated
///
/// If d = r_i, or for λ → 0, S_i and the spheres next to it are all rebuilt for each sample: 1 - g → 0.
///
///   radius    r_i, length > 0, at most r₀
///   octaves   u >= 0
///
/// Source     our tabulation (listed_rays_tables.inc, made by validate/tools/rebuild_law_table.cpp) over lines through
///            the spheres in their places at their builds.
/// Valid      isotropic lines; samples uniform in a cube or on its faces. Accuracy: see `sphere_cache_counts`.
/// Throws     std::invalid_argument for a number out of range.
[[nodiscard]] double listed_share(const Valid<Workload>& workload, double radius, double octaves);

/// A sphere around S_i.
struct EnclosingSphere {
  double radius = 0;    ///< r_l, length
  double rebuilds = 0;  ///< m_l; 0 for S₀, which is never rebuilt
  /// radius of the disc over which the distance between the centres of S_i and this sphere is spread, length
  double reach = 0;
};

/// g_i for unsorted samples. S_i has the radius r_i and is rebuilt m_i times.
///
///     g_i = √(Π_l h_l · min_l h_l)       h_l = c_l + (1 - c_l) H(r_i/r_l, reach_l/r_l)
///
///   where  l     each of the spheres in `around`: the next ones around S_i, at most six, with S₀ if it is among them
///          c_l   share of the rebuilds of S_i that also rebuild S_l, so that both have the same centre: m_l/m_i
///          H     both_hit_share averaged over a centre uniform in the disc of radius reach_l
///
/// If the lost rays of different spheres were independent, the product would be right; if they were nested, the
/// minimum. The formula is the geometric mean of both. Source: our derivation. Accuracy: not measured. Throws
/// std::invalid_argument unless m_i > 0, all other numbers are >= 0, and all are finite.
[[nodiscard]] double unsorted_listed_share(double radius, double rebuilds, const std::vector<EnclosingSphere>& around);

}  // namespace detp::model
