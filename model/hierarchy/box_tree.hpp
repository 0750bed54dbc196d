#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// The box tree: lists of rays culled down a tree of boxes.
///
/// With P(node) the share of the rays that its cull lists,
///
///     tests of boxes = n_R Σ_inner P(node) children        listed = n_R Σ P(node)
///     disc tests     = n_R Σ_leaves P(node) discs          P of the root is 1
///
/// which is exact once the tree is known (validate/structural_boxes.hpp). From numbers alone the builder's decisions
/// are followed on the tree that is expected of random samples, level by level:
///
///   box_tree_cells.hpp      how many cells the curve has on each level, and how many samples they expect
///   box_tree_boxes.hpp      the mean box around m discs in a cell
///   box_tree_expected.hpp   which cells are nodes of the binary tree, and which nodes are leaves
///   box_tree.cpp            which inner nodes are joined into wide ones
///
///     lines      P = F/(4π r₀²)                      segments   P = (V + ℓF/4)/V_box   (crossing_probability)
///
///   where  F, V   surface and volume of the convex body whose lines the cull lists (a box; for the simd engine some 9
///   %
///                 more surface); means over the nodes of a level
///
/// A wide node joins an inner node with the f - 1 inner nodes around its top that have the largest boxes: here the
/// least deep ones. Of the X inner nodes at most j levels below one, E[min(f - 1, X)] are joined, X taken as normal,
/// its mean and variance those of a branching process: a half of an inner node is inner with the probability of its
/// level.
///
/// For samples between D = 2 and D = 3 logarithms of the counts are interpolated.
namespace detp::model {

/// Larger fan-outs have the counts of this one. Larger leaves have the counts of a leaf of this size with
/// proportionally fewer samples.
inline constexpr int box_tree_most_children = 16;
inline constexpr int box_tree_largest_leaf = 256;

/// Expected counts of the tree, by either engine. `culls` are the lists made, `visits` the discs of leaves whose lists
/// hold a ray: for each block of rays again (ray_blocks).
///
/// Source     our derivation.
/// Valid      fan-out 2 … 16, leaf 1 … 256; samples uniform over a volume or over surfaces, discs turned isotropically.
/// Accuracy   against structural counts of 400 fresh sets of samples in a cube and on its faces, random fan-out
///            and leaf, n_P 2¹⁰ … 2²⁰, d 2⁻¹⁰ … 2³ sample distances but 0.16 of the side at most (seed 20261122 of
///            validate/tools/box_tree_accuracy.cpp); off in the median, at the 95th percentile and at worst:
///                            D = 2               D = 3
///              tests boxes   3.1, 6.9, 8.8 %     0.3, 1.8, 2.7 %
///              rays listed   2.2, 5.7, 6.6 %     0.4, 2.1, 3.1 %
///              tests discs   2.1, 9.4, 35.9 %    0.7, 5.5, 19.5 %
///              culls         1.6, 6.8, 10.1 %    0.6, 3.3, 7.6 %
///            With small leaves and discs, few nodes test most discs, and one set of samples differs from the next.
///            Against means over sets, disc tests are off by more than 12 % for two of the 400 trees, both with one
///            sample a leaf and D = 2; for D = 3 by 9.7 % at worst.
///            `visits` are off by less than 0.1 % in the median, by 40 % at the 95th percentile, and up to 13 times
///            too many for one sample a leaf and few rays: boxes of one level are taken as equal.
///            With n_P 2⁵ … 2¹⁰ sets differ more: of 200, off by 1.8, 3.0, 5.6, 3.5 % in the median against one set
///            each; against means over sets at worst by 7.5, 13.1, 28.4, 16.6 %. In scenes: validate/choice/README.md.
/// Limits     n_P <= leaf: one leaf, every ray tested with every disc.
/// Costs      10 … 90 µs for D = 3, 30 … 190 µs for D = 2, the more the smaller the leaf; 4 ms once for a table.
/// Throws     std::invalid_argument for a workload or parameters out of range.
[[nodiscard]] Counts<double> box_tree_counts(const Valid<Workload>& workload,
                                             const Valid<BoxTreeParameters>& parameters, Engine engine);

}  // namespace detp::model
