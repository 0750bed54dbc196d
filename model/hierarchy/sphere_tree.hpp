#pragma once

#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The ray-stream sphere tree: lists of rays culled down a tree of nested spheres.
///
/// Runs of consecutive samples along the Lebesgue curve make leaves, f consecutive nodes a parent. Each node's sphere
/// holds its children's spheres whole (a leaf's, its discs), and its list is culled from its parent's.
///
/// Nested: S(child) ⊂ S(parent) by construction, down from the root. So every ray that crosses a node's sphere is in
/// its parent's list, the node's own holds just those, and
///
///     sphere tests = n_R (1 + Σ_nodes but the root P(parent))      disc tests = n_R Σ_leaves P(leaf) samples(leaf)
///
///   where  P   share of the rays that cross a node's sphere: F(node)/F(S₀) for lines, times, where it pokes out of S₀,
///              both_hit_share; for segments crossing_probability
///
/// That is exact once the spheres are known (validate/structural_hierarchy.hpp). From numbers alone their areas must be
/// estimated: a level of N nodes over runs of c = leaf f^l samples has
///
///     mean F = 4π (<ρ²> + 2d <ρ> + d²)      <ρ²> = a² N^{-2/D} R(N, c) K(f, l)
///
///   where  ρ   radius of the sphere around the samples themselves, length, and <ρ> its mean, of the same form
///          a   side of the cube that has the samples' volume (D = 3), or that has their area on its faces (D = 2)
///          R   of spheres around runs of c samples alone. On surfaces it grows with ln N without end: the curve's
///          jumps
///              of each size, 2^{-j} a and 4^j in number, add as much to the sum of all ρ² as those of any other size
///          K   how much larger spheres around nested spheres are, l levels above the leaves: at f = 8 from 1.04
///          to 1.43,
///              at f = 2 from 1.08 to 2.26, largest near the root
///
/// A sphere around a run pokes out of S₀ as one does whose centre lies √(M (1 - q)) from that of S₀, M the mean square
/// distance of the samples from there, q what <ρ²> of runs alone is of that around all samples: spread within runs and
/// between them add up to M.
///
/// R and K are tabulated (sphere_tree_tables.inc, made by validate/tools/sphere_tree_table.cpp).
namespace detp::model {

/// One level of the tree, expected.
struct TreeLevel {
  double nodes = 1;        ///< N, exact: those of the last run, cut short, too
  double samples = 1;      ///< c, in each node but the last
  double mean_radius = 0;  ///< <ρ> + d
  double rms_radius = 0;   ///< √<(ρ + d)²>
  double rays = 0;         ///< mean length of a node's list
};

/// The levels from the root down to the leaves.
///
/// Valid      samples uniform over a volume or surfaces that fill their box; 1 <= n_P <= 1e18.
/// Errors     std::invalid_argument for a workload or parameters out of range.
/// Accuracy   see sphere_tree_counts.
[[nodiscard]] std::vector<TreeLevel> sphere_tree_levels(const Workload& workload,
                                                        const SphereTreeParameters& parameters);

/// Expected counts of the sphere tree.
///
/// Accuracy   against the structural counts of samples in a cube and on its faces, f 2 … 16, leaves of 1 … 100, d 0.1 …
/// 2
///            sample distances: n_P 20 000 … 200 000 (882 trees), sphere tests off by 1.0 % in the median, 3.9 % at the
///            95th percentile and 13 % at worst; disc tests by 0.8 %, 4.3 % and 9.2 % (leaves of 2 samples, whose few
///            largest spheres chance makes); at the built-in unit costs, time by 0.8 %, 2.5 % and 3.9 %. With 1000 or
///            3000 samples too (1470 trees), time by 1.2 %, 4.9 % and 8.6 %.
[[nodiscard]] Counts<double> sphere_tree_counts(const Workload& workload, const SphereTreeParameters& parameters);

}  // namespace detp::model
