#pragma once

#include <memory>

#include "detp/model/vocabulary/vocabulary.hpp"

/// The box tree: lists of rays culled down a tree of boxes.
///
/// If P(node) is the share of the rays in the node's list,
///
///     tests of boxes = n_R Σ_inner P(node) children        listed = n_R Σ P(node)
///     disc tests     = n_R Σ_leaves P(node) discs          P of the root is 1; its rays are not listed
///
/// This is exact if the tree is known (validate/structural/structural_parts.hpp). If only the workload's numbers are
/// known, the model follows the builder's decisions level by level, on the tree expected for random samples:
///
///   box_tree_boxes.hpp      how many cells the curve has on each level, how many samples a cell expects, and the mean
///                           box around m discs in a cell
///   box_tree_expected.hpp   which cells are nodes of the binary tree, and which nodes are leaves
///   box_tree.cpp            which inner nodes are joined into wide ones
///
///     lines      P = F/(4π r₀²)                      segments   P = (V + ℓF/4)/V_box   (crossing_probability)
///
///   where  F, V   surface and volume of a convex body; the cull lists the lines that cross it. The body is the box,
///                 grown by the margin of the float engine (for both engines). For the simd engine F is some 9 %
///                 larger (box_tree_boxes.hpp). F and V are means over the inner nodes of a level, or over its leaves
///                 with about the same number of discs
///
/// A block of n rays visits a leaf's discs if the leaf's list holds a ray. Leaves with the same number of discs have
/// different boxes, so P is taken as a gamma variable of mean p and variance s p². Then the probability of a visit is
///
///     1 - (1 - n s ln(1 - p))^{-1/s}        1 - (1 - p)^n for s = 0
///
/// With fan-out f, a wide node joins f - 1 inner nodes: its top, and those below the top that have the largest boxes.
/// The model takes the least deep ones instead. Let X be the number of inner nodes at most j levels below the top,
/// including the top: E[min(f - 1, X)] of them are joined. X is taken as normal. Its mean and variance are those of a
/// branching process: a half of an inner node is an inner node with the probability of its level.
///
/// For D between 2 and 3, the logarithms of the counts are interpolated.
namespace detp::model {

/// Larger fan-outs are treated as box_tree_most_children. Larger leaves are treated as leaves of box_tree_largest_leaf
/// among proportionally fewer samples.
inline constexpr int box_tree_most_children = 16;
inline constexpr int box_tree_largest_leaf = 256;

/// Expected counts of a search by either engine. `made` counts the nodes of the binary tree, `culls` counts lists, `visits` discs of leaves whose lists hold a ray,
/// both once for each block of rays (ray_blocks).
///
/// Source     our derivation.
/// Valid      fan-out 2 … 16, leaf 1 … 256; samples uniform over a volume or over surfaces, discs turned isotropically.
/// Accuracy   against structural counts of samples in a cube and on its faces, 400 trees of random fan-out and leaf, n_P
///            2¹⁰ … 2²⁰, d 2⁻¹⁰ … 2³ sample distances but at most 0.16 of the side, means over sets with about 2¹⁷
///            samples in total (validate/tools/box_tree_accuracy.cpp). Deviations (median, 95th percentile, largest):
///                            D = 2               D = 3
///              tests boxes   3.3, 6.5, 7.7 %     0.2, 1.6, 2.4 %
///              rays listed   2.5, 6.0, 7.7 %     0.2, 1.6, 3.1 %
///              tests discs   1.2, 6.8, 15.4 %    0.3, 4.6, 9.1 %
///              culls         1.5, 6.2, 8.9 %     0.3, 3.4, 6.8 %
///              visits        0.0, 2.8, 12.1 %    0.0, 1.3, 7.0 %
///            The three trees with more than 12 % have one or two samples a leaf and small discs: then few large leaves
///            cause most disc tests, and the counts of two sets differ much. 200 trees over 2⁵ … 2¹⁰ samples: largest
///            deviation of tests of boxes 5.5 %, rays listed 15 %, disc tests 27 %, culls 15 %, visits 7 %.
///            Against counts of plain searches in the sweep (validate/sweep/results.md; n_P 10³ … 10⁷, 240 trees of
///            fan-out 2 … 16 and leaf 1 … 256): tests of boxes 0.8, 4.4, 7.7 %, rays listed 0.9, 4.4, 11.4 %, tests of
///            discs 0.7, 3.8, 8.2 %, culls 0.8, 5.9, 13.5 %, visits 0.2, 2.8, 5.3 %. In scenes:
///            validate/choice/README.md.
///            Discs of mixed radii (a lognormal distribution, 10⁴ discs, d 0.0025 … 0.04 of the side, leaf 32): tests of
///            boxes 10 %, of discs up to 33 % too few (tests/validate/choice/outlier_counts.test.cpp).
/// Limits     n_P <= leaf: one leaf, every ray tested with every disc.
/// Costs      with leaves of 4, 16 and 64: 0.57, 0.33, 0.10 million instructions for D = 3, 1.33, 1.10, 0.45 for D = 2,
///            and the sum of both between (means over 20 random cubes, valgrind --tool=callgrind). Once 4 ms to make a
///            table.
/// Throws     std::invalid_argument for a workload or parameters out of range.
[[nodiscard]] Counts<double> box_tree_counts(const Valid<Workload>& workload,
                                             const Valid<BoxTreeParameters>& parameters, Engine engine);

/// The same counts for several fan-outs over one binary tree, which is evaluated once. The workload must outlive it.
class BoxTreeShapes {
 public:
  /// leaf >= 1.
  BoxTreeShapes(const Valid<Workload>& workload, int leaf, Engine engine);
  ~BoxTreeShapes();

  /// fan_out >= 2.
  [[nodiscard]] Counts<double> counts(int fan_out);

 private:
  class Tree;

  const Valid<Workload>& workload_;
  Engine engine_;
  int leaf_;
  double in_one_ = 1;              ///< samples for each sample of the trees
  std::unique_ptr<Tree> surface_;  ///< samples on the faces of a cube; null for D >= 3
  std::unique_ptr<Tree> volume_;   ///< samples in a cube; null for D <= 2
};

}  // namespace detp::model
