#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "box_tree_boxes.hpp"

namespace detp::model::box_tree {

/// Discs in a leaf that the surface-area heuristic may make of a node, at most (sim/lists/simd/disc_tree.cpp).
inline constexpr int most_dropped = 64;

/// Standard deviations from a mean, beyond which nothing is counted.
inline constexpr double deviations = 6;

/// Whether next to no cell that expects so many samples has so few as `discs`.
[[nodiscard]] bool all_more_than(int discs, double expected);

/// Of the nodes of a level with m discs, those that the heuristic makes leaves.
struct Dropped {
  using Row = std::array<double, most_dropped + 1>;  ///< by m

  Row share;  ///< of the nodes
  Row box;    ///< their boxes over those of all nodes, surfaces and volumes
};

/// Which nodes of more discs than a leaf become leaves because children would cost more, by the surface-area heuristic
/// of sim/lists/simd/disc_tree.hpp. A node of m <= 64 discs is dropped if
///
///     Z = 1.6 A + (A_l + A_r)/2 + c_l + c_r - m A >= 0
///
///   where  A, A_l, A_r   half the surfaces of the boxes of the node and its children
///          c_l, c_r      costs of the children: m A of a leaf, of others the smaller side
///
/// The mean of Z follows, from the smallest cells upwards, from the mean boxes of m discs and the halves' binomial
/// numbers. Around it Z is taken as normal, with the deviation
///
///     σ = 0.215 A m^0.7 (A_0/A)^0.35 · 1.1 (D = 2) · 1.13 (leaf > 1) · (1 + 1.2 p (1 - p)) (leaf = 1)
///
///   where  A_0   area if the discs were points;   p   share of the children with two discs that are dropped
///
/// and for pairs of discs A as a gamma variable of shape 4. Dropped nodes have smaller boxes than others, by the share
/// 0.3 σ φ(z)/(Φ(z) A (m - 1.6)), z = E[Z]/σ.
///
/// Source     our derivation; the numbers in σ, 0.3 and 4 are fitted to counts of some 270 sets of samples.
class Drops {
 public:
  /// Samples uniform in a cube of side 1 (dimension 3) or on its faces (2), discs of that radius.
  Drops(int dimension, double samples, double radius, int leaf);

  /// Of nodes that are cells of this kind. Null: none is dropped.
  [[nodiscard]] const Dropped* of(const CellKind& cell) const;

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
  double least_side_;            ///< in smaller cells boxes are alike: all nodes are dropped
  double least_discs_;           ///< where fewer are expected, next to no cell has more than a leaf
  std::vector<Dropped> levels_;  ///< by CellKind::halvings
};

}  // namespace detp::model::box_tree
