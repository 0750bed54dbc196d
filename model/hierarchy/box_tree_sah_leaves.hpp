#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "box_tree_boxes.hpp"
#include "detp/model/vocabulary/box_tree_split.hpp"

namespace detp::model::box_tree {

/// Largest number of discs of a node that the surface-area heuristic may turn into a leaf.
inline constexpr int largest_sah_leaf = box_tree_split::largest_leaf;

/// Values farther from the mean than this many standard deviations are neglected.
inline constexpr double deviations = 6;

/// True if almost every cell that expects `expected` discs has more than `discs`.
[[nodiscard]] bool almost_all_exceed(int discs, double expected);

/// The nodes of a level that the surface-area heuristic turns into leaves, by their number of discs m.
struct SahLeaves {
  using Row = std::array<double, largest_sah_leaf + 1>;  ///< indexed by m

  Row share;  ///< share of the nodes with m discs that become leaves
  Row box;    ///< surface (and volume) of these leaves' boxes over that of the boxes of all nodes with m discs
};

/// Predicts which nodes become leaves although they have more than `leaf` discs, because children would cost more by
/// the surface-area heuristic (model/vocabulary/box_tree_split.hpp). A node of m <= 64 discs becomes a leaf if
///
///     Z = 1.6 A + (A_l + A_r)/2 + c_l + c_r - m A >= 0
///
///   where  A, A_l, A_r   half the surfaces of the boxes of the node and its children
///          c_l, c_r      costs of the children. A node's cost is m A if it is a leaf, else m A + Z
///
/// The mean of Z is computed from the smallest cells upwards, from the mean boxes of m discs and the binomial
/// distribution of discs over the halves. Z is taken as normal around this mean, with the standard deviation (a factor
/// with a condition in brackets applies only under this condition)
///
///     σ = 0.215 A m^0.7 (A_0/A)^0.35 · 1.1 (D = 2) · 1.13 (leaf > 1) · (1 + 1.2 p (1 - p)) (leaf = 1)
///
///   where  A_0   area if the discs were points;   p   share of the children with two discs that become leaves
///
/// These leaves have smaller boxes than other nodes, by the share 0.3 σ φ(z)/(Φ(z) A (m - 1.6)), where z = E[Z]/σ and
/// φ, Φ are the density and the distribution function of the standard normal.
///
/// For nodes of 2 … 6 discs, with one disc per leaf, Z is far from normal. Their shares, boxes and costs are tabulated
/// by d (root mean square) over the cell's side and the shape of the cell (validate/tools/box_tree_sah_leaves_table.cpp).
///
/// If two or three faces of the cube pass through a cell, its halves differ. Except for the tabulated nodes, the share
/// of leaves is then q (1 + 0.75 (1 - q)⁵), where q is the share for a cell on one face.
///
/// Source     our derivation; the numbers in σ, 0.3 and 0.75 are fitted to counts of about 270 sets of samples.
class SahLeafModel {
 public:
  /// Samples uniform in a cube of side 1 (dimension 3) or on its faces (2). The ends must outlive the model.
  SahLeafModel(int dimension, double samples, const BoxEnds& ends, int leaf);

  /// The leaves among the nodes at cells of this kind; null if there are none. The result is valid until the next call.
  [[nodiscard]] const SahLeaves* for_cell(const CellKind& cell);

 private:
  using Row = SahLeaves::Row;

  [[nodiscard]] bool is_undecided(const CellKind& cell, double samples) const;
  void start_from_leaves(const CellKind& cell, Row& area, Row& cost);
  void compute_from_halves(const CellKind& cell, int most, Row& area, Row& cost);
  [[nodiscard]] double deviation_factor(double leaf_share_of_pairs) const;
  [[nodiscard]] double point_box_share(const CellKind& cell, int discs, double area) const;

  const BoxEnds& ends_;
  int leaf_;
  bool on_faces_;
  double least_side_;              ///< in smaller cells all boxes are about equal, and all nodes become leaves
  double least_discs_;             ///< almost no cell that expects fewer discs has more discs than a leaf
  std::vector<SahLeaves> levels_;  ///< indexed by CellKind::halvings
  SahLeaves at_edge_{};            ///< result of for_cell for a cell that two faces of the cube pass through
};

}  // namespace detp::model::box_tree
