#pragma once

#include <stop_token>
#include <vector>

#include "detp/sim/search/problem.hpp"

namespace detp::sim {

/// An inner node's children lie together, the lower part first; a leaf's are references to discs.
struct BspNode {
  double plane = 0;         ///< of an inner node: where it is split
  std::uint32_t first = 0;  ///< first child, or first reference
  std::uint32_t count = 0;  ///< references of a leaf
  int axis = -1;            ///< across which an inner node is split; -1: a leaf

  [[nodiscard]] bool leaf() const { return axis < 0; }
};

/// A box split in two again and again by planes across its axes; the discs that overlap each leaf.
struct BspNodes {
  Box box;
  std::vector<BspNode> nodes;  ///< the root first
  std::vector<std::uint32_t> references;
  std::size_t placements = 0;
  double building_bytes = 0;  ///< predicted memory while it was built, at its peak

  [[nodiscard]] std::span<const std::uint32_t> references_in(const BspNode& leaf) const {
    return std::span(references).subspan(leaf.first, leaf.count);
  }
};

/// The part of a box below or above a plane across an axis.
[[nodiscard]] Box part_of(Box box, int axis, double plane, bool above);

/// Builds the tree of a problem's discs, each listed in every leaf that it overlaps.
///
/// Every plane halves the longest side of its box, as Sung and Shirley's do (Graphics Gems III, which the paper cites);
/// whether there is one is decided by the surface-area heuristic. A line through a box of area F goes through its half,
/// of area F', with probability F'/F, so that a node is split where, in disc tests,
///
///     F'/F (2 v + n_low + n_high) < n
///
///   where  n              discs in the node
///          n_low, n_high  those whose bounds reach into the half
///          v              cost of visiting a node: a quarter of the parameter `leaf`, so that a cube of discs much
///                         smaller than itself is split just if it holds more than `leaf`
///
/// Discs that are in both halves alike, as coincident ones are, end the splitting. Placing the planes by the heuristic
/// too, at the best of 15 places along each axis, saves tests but no time (sim/index/experiments.md).
///
/// Throws Stopped if a stop was requested, and std::length_error, naming the bytes, before it would take
/// more than the memory budget.
[[nodiscard]] BspNodes build_bsp(const Problem& problem, const BspParameters& parameters, const std::stop_token& stop);

}  // namespace detp::sim
