#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/search/outcome.hpp"
#include "frame.hpp"
#include "ray_list.hpp"

/// A tree of boxes over the discs, down which lists of rays are culled.
namespace detp::sim::stream {

/// A disc in the frame's coordinates.
struct alignas(32) FloatDisc {
  float centre[3];
  float normal[3];
  float radius;
  float band;  ///< Frame::band
};

/// A box and its content: nodes first … first + count - 1 or, in a leaf, the discs at these places of the tree's order.
struct TreeNode {
  float centre[3];
  float half[3];  ///< half its sides
  std::uint32_t first;
  std::uint32_t count : 31;
  std::uint32_t leaf : 1;
};

struct DiscTree {
  std::vector<TreeNode> nodes;       ///< the root is first; children of a node are adjacent
  std::vector<FloatDisc> discs;      ///< in the order of the leaves
  std::vector<std::uint32_t> order;  ///< their numbers in the problem
  std::size_t binary_nodes = 0;      ///< number of nodes of the binary tree from which it was made
  /// expected sizes of the lists: a line meets a box with a probability of the box's surface over that of S₀
  ListCapacity lists;
};

inline constexpr double binary_node_bytes = 40;

/// Predicted peak bytes while the tree is built: sorted discs, nodes of the binary tree and of the wide one.
[[nodiscard]] double building_bytes(std::size_t discs, double binary_nodes, double nodes);

/// Consecutive places of the tree's order.
struct DiscRun {
  std::uint32_t first;
  std::uint32_t count;
};

/// The discs of the leaves below a node, or of a leaf.
[[nodiscard]] DiscRun discs_below(const DiscTree& tree, const TreeNode& node);

/// Splits the discs, sorted along the Morton curve, wherever the curve leaves a cell. Then keeps the splits that lower
/// the expected cost, and joins them to nodes with up to `fan_out` children. A leaf holds up to `leaf` discs; more only
/// if that costs less (or if they have the same place on the curve: such discs are split in the middle).
///
/// The expected cost follows the surface-area heuristic: a line that crosses a node crosses a child with probability
/// F(child)/F(node). (With runs of equal length along the curve as nodes, there would be 1.7 to 2.3 times as many
/// tests, because their boxes span the curve's jumps.)
///
/// Throws Stopped if a stop was requested, and std::length_error, naming the bytes, before it would exceed the memory
/// budget, or for 2³¹ or more discs.
[[nodiscard]] DiscTree make_disc_tree(const Problem& problem, const Frame& frame, const BoxTreeParameters& parameters,
                                      const RunOptions& options = {});

/// Only the discs in that order: a tree without nodes. Throws Stopped if a stop was requested.
[[nodiscard]] DiscTree discs_in_order(const Problem& problem, const Frame& frame, std::vector<std::uint32_t> order,
                                      const RunOptions& options = {});

}  // namespace detp::sim::stream
