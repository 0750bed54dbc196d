#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "detp/model/vocabulary/box_tree_split.hpp"
#include "detp/sim/geometry/curve_sort.hpp"
#include "disc_boxes.hpp"
#include "disc_tree.hpp"

/// The binary tree of boxes over sorted discs. Trees with wide nodes and larger leaves are made from it.
namespace detp::sim::stream {

/// A node of the binary tree. An inner node's left child is the next node.
struct BinaryNode {
  FloatBox box;
  std::uint32_t first;  ///< its discs are first … first + count - 1 in the order along the curve
  std::uint32_t count;
  std::uint32_t right;  ///< number of the right child; 0: a leaf
  float cost;           ///< expected cost of a ray that crosses the box, times the box's area
  [[nodiscard]] bool leaf() const { return right == 0; }
};

static_assert(sizeof(BinaryNode) == binary_node_bytes);

/// The place at which a run of discs leaves the first half of the smallest cell that contains the run; the run's middle
/// if all its discs have the same place on the curve.
[[nodiscard]] std::uint32_t boundary(std::span<const CurvePlace> places, std::uint32_t first, std::uint32_t count);

/// The cost of a node that is not empty, times the area of its box, and whether it is an inner node: it is a leaf if that
/// costs less and if it has at most box_tree_split::largest_leaf discs. `children` is the sum of the areas of the
/// children's boxes, `below` the sum of their costs.
struct NodeCost {
  float cost;
  bool inner;

  NodeCost(float area, std::uint32_t count, float children, float below) {
    constexpr auto cull = static_cast<float>(box_tree_split::cull);
    constexpr auto list = static_cast<float>(box_tree_split::list);
    const float as_inner = cull * area + list * children + below;
    const float as_leaf = static_cast<float>(count) * area;
    inner = as_leaf > as_inner || count > box_tree_split::largest_leaf;
    cost = inner ? as_inner : as_leaf;
  }
};

/// Gives an inner node the box of its children, and makes it a leaf if that costs less: sets `right` and `cost`.
void join(BinaryNode& node, const BinaryNode& left, const BinaryNode& right, std::uint32_t right_number);

/// Writes the binary tree over a run of discs to nodes[number] and the next nodes, at most 2 count - 1. Every run of at
/// most `leaf` discs is a leaf. Returns the number after its last node.
std::uint32_t split_run(const SortedDiscs& discs, std::uint32_t leaf, std::uint32_t first, std::uint32_t count,
                        BinaryNode* nodes, std::uint32_t number);

/// A child of a wide node.
struct WideChild {
  std::uint32_t node;
  float inner_area;  ///< area of its box; negative for a leaf
};

/// Replaces `children` by the children of the wide node at an inner node: starts with its two children, then replaces
/// the inner node with the largest box by its own children, until there are `fan_out` children or only leaves.
/// `halves(node)` returns a node's two children.
template <class Halves>
void open_wide_node(std::uint32_t node, std::size_t fan_out, const Halves& halves, std::vector<WideChild>& children) {
  const std::pair<WideChild, WideChild> two = halves(node);
  children.assign({two.first, two.second});
  while (children.size() < fan_out) {
    const auto largest = std::max_element(children.begin(), children.end(), [](const WideChild& x, const WideChild& y) {
      return x.inner_area < y.inner_area;
    });
    if (largest->inner_area < 0) break;
    const std::pair<WideChild, WideChild> parts = halves(largest->node);
    *largest = parts.first;
    children.insert(largest + 1, parts.second);
  }
}

}  // namespace detp::sim::stream
