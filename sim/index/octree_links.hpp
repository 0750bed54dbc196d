#pragma once

#include <array>
#include <limits>

#include "octree_nodes.hpp"

namespace detp::sim {

inline constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

/// An inner node, a leaf, or an octant without discs, which is a leaf without references.
struct LinkedNode {
  /// For face number 2 axis + (1 for the upper face): the adjacent node of the same size, or the larger leaf there;
  /// no_node at the cube's faces.
  std::array<std::uint32_t, 6> links;
  std::uint32_t first = 0;  ///< number of the first of eight children, or of the first reference
  std::uint32_t count = 0;  ///< number of references
  std::uint8_t level = 0;
  bool inner = false;
};

/// Returns the nodes of an octree, completed to eight children for each inner node, and linked to their neighbours. The
/// root is first, parents come before children.
///
/// Source  H. Samet: Implementing ray tracing with octrees and neighbor finding (1989); here the links are stored, not
///         found while tracing.
/// Throws  std::length_error for 2³² or more nodes, or, naming the bytes, if they would not fit in memory; Stopped if a
///         stop was requested.
[[nodiscard]] std::vector<LinkedNode> link_neighbours(const OctreeNodes& tree, const std::stop_token& stop);

}  // namespace detp::sim
