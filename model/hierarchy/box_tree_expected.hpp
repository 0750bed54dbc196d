#pragma once

#include <vector>

#include "box_tree_boxes.hpp"

/// The binary tree from which the box tree is made, on average over sets of samples.
namespace detp::model::box_tree {

/// Sums over bodies: their number, and the surface and volume of their boxes (MeanBox).
struct Sums {
  double count = 0;
  double surface = 0;
  double volume = 0;

  void add(double times, const MeanBox& box) {
    count += times;
    surface += times * box.surface;
    volume += times * box.volume;
  }
};

/// Leaves that have about the same number of discs.
struct Leaves {
  double count = 0;
  double discs = 0;    ///< in each of them
  double surface = 0;  ///< mean of their boxes (MeanBox); volume and spread likewise
  double volume = 0;
  double spread = 0;
};

/// Expected nodes of the binary tree that have exactly the discs of a cell of one kind.
struct LevelNodes {
  Sums inner;
  std::vector<Leaves> leaves;
};

/// The expected nodes for each of cell_kinds(dimension, samples), up to the last kind that has nodes. Samples are
/// uniform in a cube of side 1 (dimension 3) or on its faces (2).
///
/// A cell of m samples is a node if no ancestor is a leaf and, for m > leaf, both its halves hold samples. The
/// probability that no ancestor is a leaf is
///
///     a(m) = Σ_s P(s) a'(m + s) (1 - q'(m + s))
///
///   where  P(s)    binomial probability of s samples in the other half of the parent
///          q(m)    probability that a node of m samples is a leaf
///          a', q'  a and q of the parent; q' = 0 for s = 0 and m > leaf, since the parent is then no node
///
/// Every node of m <= leaf samples is a leaf, and some nodes of m <= 64 are (box_tree_sah_leaves.hpp).
///
/// Source     our derivation. Valid range and accuracy: see box_tree.hpp.
[[nodiscard]] std::vector<LevelNodes> expected_binary_tree(int dimension, double samples, const BoxEnds& ends, int leaf,
                                                           const Listing& listing = {});

}  // namespace detp::model::box_tree
