#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The sphere tree: lists of rays are culled down a tree of nested spheres.
///
/// Runs of consecutive samples along the Morton curve (the paper: Lebesgue curve) are leaves; f consecutive nodes have
/// one parent. A node's sphere contains its children's spheres, a leaf's sphere its discs. Each node's list is culled
/// from its parent's list.
///
/// Nested: S(child) ⊂ S(parent) by construction, from the root down. So every ray that crosses a node's sphere is in
/// its parent's list, and the node's own list holds exactly these rays:
///
///     sphere tests = n_R (1 + Σ_{nodes except the root} P(parent))
///     disc tests   = n_R Σ_leaves P(leaf) samples(leaf)
///
///   where  P   share of the rays that cross a node's sphere. Lines: F(node)/F(S₀), times both_hit_share if the sphere
///              extends outside S₀. Segments: crossing_probability
///
/// This is exact if the spheres are known (validate/structural/structural_hierarchy.cpp). If only the workload's
/// numbers are known, the areas F of the spheres are estimated. On a level of N nodes over runs of c = leaf f^l samples
///
///     mean F = 4π (<ρ²> + 2d <ρ> + d²)      <ρ²> = a² N^{-2/D} R(N, c) K(f, l)
///
///   where  ρ   radius of a node's sphere minus d, length; <> is the mean over the level. <ρ>² has the form of <ρ²>,
///              with an R and a K of its own
///          a   side of the cube that has the samples' volume (D = 3), or that has their area on its faces (D = 2)
///          R   factor for spheres around runs of c samples, not nested. On surfaces R grows with ln N without limit:
///              the curve has 4^j jumps of size 2^{-j} a, so the jumps of each size add the same to Σ ρ²
///          K   factor for nesting, l levels above the leaves: for f = 8 from 1.04 to 1.43, for f = 2 from 1.08 to
///              2.26, largest near the root
///
/// The distance of a node's sphere from the centre of S₀ is taken as √(M (1 - q)). M is the mean square distance of the
/// samples from that centre; q is <ρ²> of the node's run divided by that of all samples, both without nesting. (The
/// spreads within runs and between runs add up to M.)
///
/// R and K are tabulated (sphere_tree_tables.inc, made by validate/tools/sphere_tree_table.cpp).
namespace detp::model {

/// Expected values of one level of the tree.
struct TreeLevel {
  double nodes = 1;       ///< N, exact, including nodes over the shorter last run
  double samples = 1;     ///< c, in each node except the last
  double rms_radius = 0;  ///< √<(ρ + d)²>
  double rays = 0;        ///< mean length of a node's list
};

/// The levels from the root down to the leaves.
///
/// Valid      samples uniform over a volume or surfaces that fill their box; 1 <= n_P <= 1e18.
/// Throws     std::invalid_argument for a workload or parameters out of range.
/// Accuracy   see sphere_tree_counts.
[[nodiscard]] std::vector<TreeLevel> sphere_tree_levels(const Valid<Workload>& workload,
                                                        const Valid<SphereTreeParameters>& parameters);

/// Expected counts of the sphere tree. Throws as sphere_tree_levels does.
///
/// Accuracy   compared with the structural counts of samples in a cube and on its faces, f 2 … 16, leaves of 1 … 100, d
///            0.1 … 2 sample distances. Deviations (median, 95th percentile, largest) for n_P 20 000 … 200 000 (882
///            trees): sphere tests 1.0, 3.9, 13 %; disc tests 0.8, 4.3, 9.2 % (for leaves of 2 samples: the few
///            largest spheres are random); time at the built-in unit costs 0.8, 2.5, 3.9 %. Including 1000 and 3000
///            samples (1470 trees): time 1.2, 4.9, 8.6 %. culls and visits are too large where most lists are empty,
///            because all lists of a level are taken as equally long: 0.03, 29, 64 % and 2.6, 103, 139 % in the sweep
///            (validate/sweep/results.md), where 250 to 2000 lines cross up to 10⁷ samples.
[[nodiscard]] Counts<double> sphere_tree_counts(const Valid<Workload>& workload,
                                                const Valid<SphereTreeParameters>& parameters);

}  // namespace detp::model
