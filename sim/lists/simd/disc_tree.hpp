#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/search/outcome.hpp"
#include "frame.hpp"
#include "ray_list.hpp"

/// A tree of boxes over the discs, for lists of rays to be culled down.
namespace detp::sim::stream {

/// A disc in the frame's coordinates.
struct alignas(32) FloatDisc {
  float centre[3];
  float normal[3];
  float radius;
  float band;  ///< Frame::band
};

/// A box, and what is in it: nodes number first … first + count - 1, or, in a leaf, discs (places in the tree's order).
struct TreeNode {
  float centre[3];
  float half[3];  ///< half its sides
  std::uint32_t first;
  std::uint32_t count : 31;
  std::uint32_t leaf : 1;
};

struct DiscTree {
  std::vector<TreeNode> nodes;       ///< the root first; children of a node are neighbours
  std::vector<FloatDisc> discs;      ///< in the order of the leaves
  std::vector<std::uint32_t> order;  ///< their numbers in the problem
  std::size_t binary_nodes = 0;      ///< of the binary tree that it was made of
  ListRoom lists;                    ///< of lines that meet a box with a probability of its surface over that of S₀
};

inline constexpr double binary_node_bytes = 40;

/// Predicted bytes while the tree is built, at their peak: sorted discs, nodes of the binary tree and of the wide one.
[[nodiscard]] double building_bytes(std::size_t discs, double binary_nodes, double nodes);

/// Places of the tree's order, one after another.
struct DiscRun {
  std::uint32_t first;
  std::uint32_t count;
};

/// The discs of the leaves below a node, or of a leaf.
[[nodiscard]] DiscRun discs_below(const DiscTree& tree, const TreeNode& node);

/// Splits the discs, sorted along the Lebesgue curve, wherever the curve leaves a cell; then keeps those splits that
/// pay, and joins them into nodes of up to `fan_out` children. A leaf holds up to `leaf` discs, more only where that
/// costs less (or where they share a place on the curve: such are split in the middle).
///
/// What pays is judged by the surface-area heuristic: a line that crosses a node crosses a child with probability
/// F(child)/F(node). (Runs of equal length along the curve, as nodes, take 1.7 to 2.3 times the tests: their boxes
/// bridge the curve's jumps.)
///
/// Throws Stopped if a stop was requested, and std::length_error, naming the bytes, before it would take more than the
/// memory budget, or for 2³¹ or more discs.
[[nodiscard]] DiscTree make_disc_tree(const Problem& problem, const Frame& frame, const BoxTreeParameters& parameters,
                                      const RunOptions& options = {});

/// The discs alone, in that order: a tree without nodes. Throws Stopped if a stop was requested.
[[nodiscard]] DiscTree discs_in_order(const Problem& problem, const Frame& frame, std::vector<std::uint32_t> order,
                                      const RunOptions& options = {});

}  // namespace detp::sim::stream
