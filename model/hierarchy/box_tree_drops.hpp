#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "box_tree_boxes.hpp"

namespace detp::model::box_tree {

/// Largest number of discs of a node that the surface-area heuristic may turn into a leaf
/// (sim/lists/simd/disc_tree.cpp).
inline constexpr int most_dropped = 64;

/// Values farther from the mean than this many standard deviations are neglected.
inline constexpr double deviations = 6;

/// Whether almost every cell that expects `expected` samples has more than `discs`.
[[nodiscard]] bool all_more_than(int discs, double expected);

/// For the nodes of a level with m discs: the share that the heuristic turns into leaves.
struct Dropped {
  using Row = std::array<double, most_dropped + 1>;  ///< indexed by m

  Row share;  ///< of the nodes
  Row box;    ///< their boxes relative to those of all nodes, for surfaces and volumes
};

/// Nodes with more discs than a leaf that become leaves nevertheless, because children would cost more by the
/// surface-area heuristic of sim/lists/simd/disc_tree.hpp. A node of m <= 64 discs is dropped (made a leaf) if
///
///     Z = 1.6 A + (A_l + A_r)/2 + c_l + c_r - m A >= 0
///
///   where  A, A_l, A_r   half the surfaces of the boxes of the node and its children
///          c_l, c_r      costs of the children: m A for a leaf, for other nodes the smaller side of the inequality
///
/// The mean of Z is computed from the smallest cells upwards, from the mean boxes of m discs and the binomial numbers
/// of discs in the halves. Z is taken as normal around this mean, with the deviation
///
///     σ = 0.215 A m^0.7 (A_0/A)^0.35 · 1.1 (D = 2) · 1.13 (leaf > 1) · (1 + 1.2 p (1 - p)) (leaf = 1)
///
///   where  A_0   area if the discs were points;   p   share of the children with two discs that are dropped
///
/// Dropped nodes have smaller boxes than others, by the share 0.3 σ φ(z)/(Φ(z) A (m - 1.6)), z = E[Z]/σ.
///
/// For nodes of 2 … 6 discs, with one disc per leaf, Z is far from normal. Their shares, boxes and costs are tabulated
/// by d over the cell's side and the shape of the cell (validate/tools/box_tree_drops_table.cpp). Where two faces of the
/// cube pass through a cell, its halves differ: the shares q of larger nodes, or for larger leaves, are those of faces
/// times 1 + 0.75 (1 - q)⁵.
///
/// Source     our derivation; the numbers in σ, 0.3 and 0.75 are fitted to counts of about 270 sets of samples.
class Drops {
 public:
  /// Samples uniform in a cube of side 1 (dimension 3) or on its faces (2), discs of that radius.
  Drops(int dimension, double samples, double radius, int leaf);

  /// The dropped nodes among those that are cells of this kind. Null: none is dropped. The result is valid until the
  /// next call.
  [[nodiscard]] const Dropped* of(const CellKind& cell);

 private:
  using Row = Dropped::Row;

  [[nodiscard]] bool matters(const CellKind& cell, double samples) const;
  void start(const CellKind& cell, Row& area, Row& cost);
  void halve(const CellKind& cell, int most, Row& area, Row& cost);
  [[nodiscard]] double spread(double pairs_dropped) const;
  [[nodiscard]] double of_points(const CellKind& cell, int discs, double area) const;

  double radius_;
  int leaf_;
  bool on_faces_;
  double least_side_;            ///< in smaller cells all boxes are about equal, and all nodes are dropped
  double least_discs_;           ///< in cells that expect fewer, almost none has more discs than a leaf
  std::vector<Dropped> levels_;  ///< indexed by CellKind::halvings
  Dropped at_edge_{};            ///< result of `of` for a cell that two faces of the cube pass through
};

}  // namespace detp::model::box_tree
