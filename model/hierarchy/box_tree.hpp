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
///   where  F, V   surface and volume of the convex body whose lines the cull lists: the box, grown by the margin of
///                 the float engine, for both engines; for the simd engine with some 9 % more surface
///                 (box_tree_boxes.hpp). Means over the inner nodes of a level, and over its leaves of about the same
///                 number of discs
///
/// A leaf's discs are visited by a block of n rays if its list holds a ray. Boxes of leaves with the same number of discs
/// differ: P is taken as a gamma variable of mean p and variance s p², so that the probability is
///
///     1 - (1 - n s ln(1 - p))^{-1/s}        1 - (1 - p)^n for s = 0
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
/// Accuracy   against structural counts of samples in a cube and on its faces, 200 trees of random fan-out and leaf,
///            n_P 2¹⁰ … 2¹⁷, d 2⁻¹⁰ … 2³ sample distances but at most 0.16 of the side, means over sets that hold 2¹⁶
///            samples together (at least two sets); off in the median, at the 95th percentile and at worst:
///                            D = 2               D = 3
///              tests boxes   2.7, 5.9, 8.1 %     0.2, 1.2, 1.7 %
///              rays listed   1.9, 6.1, 7.6 %     0.3, 1.6, 2.2 %
///              tests discs   1.6, 8.3, 11.2 %    0.4, 6.0, 19.0 %
///              culls         1.3, 7.1, 11.4 %    0.5, 3.0, 5.2 %
///              visits        0.0, 3.1, 7.0 %     0.0, 3.2, 12.0 %
///            Disc tests are worst with one sample per leaf and small discs: then few large leaves test most discs, and
///            the mean over 2¹⁶ samples has a standard error of 3 to 12 %. Counted again on about a million samples, the
///            two trees beyond 12 % are off by 2 and 7 %, and three with D = 2 and one sample per leaf (n_P 1267, 7974,
///            73 957) by 9, 10 and 4 %. (validate/tools/box_tree_accuracy.cpp makes such comparisons.) In scenes:
///            validate/choice/README.md.
/// Limits     n_P <= leaf: one leaf, every ray tested with every disc.
/// Costs      10 … 90 µs for D = 3, 30 … 190 µs for D = 2, the more the smaller the leaf; 4 ms once for a table.
/// Throws     std::invalid_argument for a workload or parameters out of range.
[[nodiscard]] Counts<double> box_tree_counts(const Valid<Workload>& workload,
                                             const Valid<BoxTreeParameters>& parameters, Engine engine);

}  // namespace detp::model
