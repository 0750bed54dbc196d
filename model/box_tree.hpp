#pragma once

#include <array>

#include "vocabulary.hpp"

/// The sphere tree with boxes: lists of rays culled down a tree of boxes.
///
/// With P(node) the share of the rays that its cull lists,
///
///     tests of boxes = n_R Σ_inner P(node) children        listed = n_R Σ P(node)
///     disc tests     = n_R Σ_leaves P(node) discs          P of the root is 1
///
/// which is exact once the tree is known (validate/structural_boxes.hpp). Where it splits is decided by the samples and
/// the surface-area heuristic; so from numbers alone the sums are tabulated, of each the areas and volumes,
///
///     lines      P = F/(4π r₀²)                      segments   P = (V + ℓF/4)/V_box   (crossing_probability)
///
///   where  F, V   surface of the convex body whose lines the cull lists (a box's, and some 9 % more), its volume
///
/// over a² or a³, a the side of the cube that has the samples' volume (D = 3) or their area on its faces (D = 2), by
/// n_P and d over the distance between samples (extent / n_P)^(1/D). In between, logarithms are interpolated, as are
/// those of D = 2 and D = 3. The table (box_tree_table.inc) is made by validate/tables/box_tree_table.cpp.
namespace detp::model {

/// The trees that the table is of: of this fan-out, with a leaf of one of these. box_tree_rule.hpp says which one suits
/// a workload.
inline constexpr int box_tree_fan_out = 4;
inline constexpr std::array box_tree_leaves{8, 16, 64};

/// Whether the table is of this tree, so that box_tree_counts knows it.
[[nodiscard]] bool is_tabulated(const BoxTreeParameters& tree);

/// Expected counts of the tree. `culls` are tests of a node that any ray takes part in.
///
/// Source     our derivation, and the table.
/// Valid      fan-out 4, leaf 8, 16 or 64; samples uniform over a volume or over surfaces, discs turned isotropically;
///            n_P from two leaves to 2²⁰, d 2⁻⁴ … 2⁶ sample distances. Beyond more samples it goes on as the table
///            ends, beyond the others it stays.
/// Accuracy   against structural counts of 60 fresh sets of samples for each leaf, in a cube and on its faces, n_P 2¹⁰
/// …
///            2²⁰, d 2⁻¹⁰ … 2³ sample distances but 0.16 of the side at most; off in the median, at the 95th percentile
///            and at worst:
///              leaf          8                   16                  64
///              tests boxes   2.0, 4.8, 5.7 %     2.0, 4.1, 6.2 %     2.6, 8.1, 15.7 %
///              rays listed   3.5, 10.6, 11.3 %   3.8, 9.8, 11.3 %    3.3, 14.0, 21.7 %
///              tests discs   8.9, 21.8, 23.3 %   6.1, 13.4, 14.5 %   5.5, 13.1, 16.1 %
///            `culls` by 3 … 10 % in the median and 73 % at worst: too many where there are fewer rays than nodes.
///            In scenes see README.md.
/// Throws     std::invalid_argument for a workload out of range, and for any other tree.
[[nodiscard]] Counts<double> box_tree_counts(const Workload& workload, const BoxTreeParameters& parameters);

}  // namespace detp::model
