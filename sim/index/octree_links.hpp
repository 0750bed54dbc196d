#pragma once

#include <array>
#include <limits>

#include "octree_nodes.hpp"

namespace detp::sim {

inline constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

/// An inner node, a leaf, or an octant without a disc, which is a leaf without references.
struct LinkedNode {
  /// Across each face, 2 axis + (1 for the upper): the node as large as this one, or the larger leaf there; no_node
  /// outside the cube.
  std::array<std::uint32_t, 6> links;
  std::uint32_t first = 0;  ///< the first of eight children, or of the references
  std::uint32_t count = 0;  ///< references
  std::uint8_t level = 0;
  bool inner = false;
};

/// The same tree with all eight children of each inner node, every node linked to its neighbours: the root first,
/// parents before children.
///
/// Source  H. Samet: Implementing ray tracing with octrees and neighbor finding (1989); the links are kept here, not
///         found while tracing.
/// Throws  std::length_error, naming the bytes, where it would not fit the memory.
[[nodiscard]] std::vector<LinkedNode> link_neighbours(const OctreeNodes& tree, const std::stop_token& stop);

}  // namespace detp::sim
