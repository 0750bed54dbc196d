#pragma once

#include <stop_token>
#include <vector>

#include "detp/sim/search/problem.hpp"

namespace detp::sim {

/// A node. An inner node's children are adjacent in the array of nodes, the lower part first. A leaf has references to
/// discs.
struct BspNode {
  double plane = 0;         ///< coordinate of an inner node's plane along the axis
  std::uint32_t first = 0;  ///< first child, or first reference
  std::uint32_t count = 0;  ///< number of references of a leaf
  int axis = -1;            ///< axis across which an inner node is split; -1: a leaf

  [[nodiscard]] bool leaf() const { return axis < 0; }
};

/// A box that is repeatedly split in two by planes across its axes, and the discs that overlap each leaf.
struct BspNodes {
  Box box;
  std::vector<BspNode> nodes;  ///< the root first
  std::vector<std::uint32_t> references;
  std::size_t placements = 0;
  double building_bytes = 0;  ///< predicted peak memory while it was built

  [[nodiscard]] std::span<const std::uint32_t> references_in(const BspNode& leaf) const {
    return std::span(references).subspan(leaf.first, leaf.count);
  }
};

/// The part of a box below or above a plane across an axis.
[[nodiscard]] Box part_of(Box box, int axis, double plane, bool above);

/// Builds the tree of a problem's discs. Each disc is listed in every leaf that it overlaps.
///
/// Every plane halves the longest side of its box, as in Sung and Shirley (Graphics Gems III, which the paper cites).
/// The surface-area heuristic decides whether to split. A line through a box of area F crosses its half, of area F',
/// with probability F'/F, so a node is split if, in units of disc tests,
///
///     F'/F (2 v + n_low + n_high) < n
///
///   where  n              discs in the node
///          n_low, n_high  discs whose bounds reach into the lower and the upper half
///          v              cost of visiting a node: a quarter of the parameter `leaf`, so that a cube whose discs are
///                         much smaller than the cube is split exactly if it holds more than `leaf` discs
///
/// Whatever the costs, a node is not split at level `depth`, or if it has at most `leaf` discs. The rule never splits a
/// node all of whose discs are in both halves, for instance because they coincide. Placing the planes by the heuristic
/// too, at the best of 15 places along each axis, saves disc tests but no time (sim/index/experiments.md).
///
/// Throws Stopped if a stop was requested, and std::length_error, naming the bytes, if the tree would exceed the memory
/// budget.
[[nodiscard]] BspNodes build_bsp(const Problem& problem, const BspParameters& parameters, const std::stop_token& stop);

}  // namespace detp::sim
