#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/curve_sort.hpp"
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

/// A box and its content: nodes first … first + count - 1; in a leaf, the discs at these places of the tree's order.
struct TreeNode {
  float centre[3];
  float half[3];  ///< half the box's sides
  std::uint32_t first;
  std::uint32_t count : 31;
  std::uint32_t leaf : 1;
};

struct DiscTree {
  UnsetVector<TreeNode> nodes;       ///< the root is first; children of a node are adjacent
  UnsetVector<FloatDisc> discs;      ///< in the order of the leaves
  UnsetVector<std::uint32_t> order;  ///< the discs' numbers in the problem
  std::size_t binary_nodes = 0;      ///< number of nodes of the binary tree from which `nodes` were made
  /// expected sizes of the lists: a line through S₀ crosses a box with probability F(box)/F(S₀), F the surface
  ListCapacity lists;
};

inline constexpr double binary_node_bytes = 40;

/// The places of some discs on the Morton curve, in its order. They depend on the discs' centres alone, so they hold for
/// the same discs with other radii.
using CurveOrder = std::shared_ptr<const CurvePlaces>;

/// Discs in the order of the Morton curve.
struct SortedDiscs {
  CurveOrder places;
  DiscTree tree;           ///< discs and order; no nodes
  double seconds = 0;      ///< for sorting
  std::size_t sorted = 0;  ///< number of discs that were sorted; 0 if their order was known
};

/// Sorts the problem's discs along the curve, enough for trees with leaves of `leaf` or more discs. Throws Stopped if a stop was
/// requested, and std::length_error for 2³¹ or more discs.
[[nodiscard]] CurveOrder curve_order(const Problem& problem, const RunOptions& options = {}, int leaf = 1);

/// The discs in the order of the curve. Throws as curve_order.
[[nodiscard]] SortedDiscs sort_discs(const Problem& problem, const Frame& frame, const RunOptions& options = {},
                                     int leaf = 1);

/// The same without sorting: `places` are those of the same discs, perhaps with other radii. Throws Stopped if a stop was requested,
/// and std::invalid_argument if the numbers of places and discs differ.
[[nodiscard]] SortedDiscs discs_in_known_order(const Problem& problem, const Frame& frame, CurveOrder places,
                                               const RunOptions& options = {});

/// Predicted peak bytes while the tree is built: sorted discs, nodes of the binary tree and of the final tree.
[[nodiscard]] double building_bytes(std::size_t discs, double binary_nodes, double nodes);

/// Consecutive places of the tree's order.
struct DiscRun {
  std::uint32_t first;
  std::uint32_t count;
};

/// The discs of the leaves below a node, or of a leaf.
[[nodiscard]] DiscRun discs_below(const DiscTree& tree, const TreeNode& node);

/// Splits the sorted discs where the curve leaves a cell. Discs with the same place on the curve are split in the middle.
/// Keeps the splits that lower the expected cost, and merges the kept splits into
/// nodes with up to `fan_out` children. A leaf holds up to `leaf` discs, or up to 64 if that costs less than a split.
///
/// The expected cost follows the surface-area heuristic: a line that crosses a node crosses a child with probability
/// F(child)/F(node). (If nodes were runs of equal length along the curve, there would be 1.7 to 2.3 times as many
/// tests, because the boxes of such runs span the curve's jumps.)
///
/// Throws Stopped if a stop was requested. Throws std::length_error, naming the bytes, before the memory budget would be
/// exceeded.
[[nodiscard]] DiscTree make_disc_tree(SortedDiscs sorted, const Problem& problem, const Frame& frame,
                                      const BoxTreeParameters& parameters, const RunOptions& options = {});

/// Sorts the discs first.
[[nodiscard]] DiscTree make_disc_tree(const Problem& problem, const Frame& frame, const BoxTreeParameters& parameters,
                                      const RunOptions& options = {});

/// Returns the discs in the given order, as a tree without nodes. Throws Stopped if a stop was requested.
[[nodiscard]] DiscTree discs_in_order(const Problem& problem, const Frame& frame, UnsetVector<std::uint32_t> order,
                                      const RunOptions& options = {});

}  // namespace detp::sim::stream
