#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// How many rays a sphere of the cache holds: n_i that cross it, L_i that its list has.
///
/// S_i is centred where it was rebuilt. Those around it were centred then or before: it pokes out of them, and out of
/// S₀ near the rim of the scene. The rays that cross S_i but miss one of them are not listed (the discs that S_i serves
/// do not need them): L_i = n_i g_i.
namespace detp::model {

/// n_i: rays that cross a sphere of radius r inside S₀.
///
///     n_i = n_R r²/r₀²   of lines;   n_R (V + ℓF/4)/V_box   of segments of mean length ℓ, V and F those of the sphere
///
/// Exact where the sphere lies in S₀ and the rays are uniform; where it pokes out, g_i tells.
[[nodiscard]] double rays_through(const Workload& workload, double radius);

/// g_i along the Lebesgue curve: share of the rays through S_i that cross all spheres around it, mean over its builds.
///
///     1 - g = deep(λ, u, d/r_i) + [shallow(r₀/r_i, u, d/r₀) - deep, for the samples that `shallow` was made with]
///
///   where  deep      by samples in a cube of side r_i, λ = n r_i^D/extent, by u = log₂(1/Q) and by how much smaller
///   the
///                    balls are than their spheres; far inside S₀
///          shallow   near S₀, out of which S_i pokes, and where S_i has fewer spheres around it
///
/// With d = r_i or with λ → 0, S_i and those next to it are all rebuilt for each sample: 1 - g → 0.
///
///   radius    r_i, length > 0, at most r₀
///   octaves   u >= 0
///
/// Source     our tabulation (listed_rays_tables.inc, made by validate/tools/rebuild_law_table.cpp) over lines laid
///            through the spheres as they stand at their builds.
/// Valid      isotropic lines; samples uniform in a cube or on its faces. Told at `sphere_cache_counts`: accuracy.
/// Throws     std::invalid_argument for a number out of range.
[[nodiscard]] double listed_share(const Workload& workload, double radius, double octaves);

/// A sphere around S_i.
struct Enclosing {
  double radius = 0;    ///< r_l, length
  double rebuilds = 0;  ///< m_l; 0 for S₀, which stays where it is
  double reach = 0;     ///< radius of the disc over which the offset of S_i's centre from its own spreads, length
};

/// g_i for samples in no order, S_i of radius r_i being rebuilt m_i times.
///
///     g_i = √(Π_l h_l · min_l h_l)       h_l = c_l + (1 - c_l) H(r_i/r_l, reach_l/r_l)
///
///   where  l     S₀ and the next spheres around S_i, six in all
///          c_l   share of the rebuilds of S_i that also rebuild S_l, and so share its centre: m_l/m_i
///          H     both_hit_share averaged over a centre uniform in the disc of radius reach_l
///
/// Were the shortfalls independent, their product would be right; were they nested, their minimum: it lies between.
/// Source: our derivation. Accuracy: not measured.
[[nodiscard]] double unsorted_listed_share(double radius, double rebuilds, const std::vector<Enclosing>& around);

}  // namespace detp::model
