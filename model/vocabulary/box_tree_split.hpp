#pragma once

/// When a box tree splits a node: the constants of the surface-area heuristic. The builder
/// (sim/lists/simd/binary_tree.hpp) decides by them, and the closed forms (model/hierarchy) predict what it decides.
///
/// A node of m discs costs m A as a leaf, and cull A + list (A_l + A_r) + c_l + c_r as an inner node, where A, A_l and A_r
/// are half the surfaces of the boxes of the node and its children, and c_l and c_r the costs of the children. The costs
/// are those of one ray, in units of disc tests, measured on lists of a few hundred rays.
namespace detp::box_tree_split {

/// One test of a ray against a box, with its share of making the list.
inline constexpr double cull = 1.6;

/// Each listed ray: 1, halved, because about every other split is merged into a wide node and then costs nothing.
inline constexpr double list = 0.5;

/// A node with more discs is split even if a leaf costs less.
inline constexpr int largest_leaf = 64;

}  // namespace detp::box_tree_split
