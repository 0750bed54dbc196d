#pragma once

#include <array>
#include <limits>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/parameters.hpp"
#include "detp/sim/search/problem.hpp"

namespace detp::sim {

/// A node. Its children are adjacent in the array of nodes, in the order of their octants. A leaf has references to
/// discs.
struct OctreeNode {
  std::uint32_t first = 0;   ///< first child, or first reference
  std::uint32_t count = 0;   ///< number of references of a leaf
  std::uint8_t octants = 0;  ///< the existing children: bit (x + 2y + 4z)
};

/// A cube that is cut into octants `depth` times, and the discs of each leaf. Octants without discs are omitted.
struct OctreeNodes {
  Box cube;
  int depth = 0;
  std::vector<OctreeNode> nodes;  ///< the root first
  std::vector<std::uint32_t> references;
  std::size_t placements = 0;
  double building_bytes = 0;  ///< predicted peak memory while it was built

  [[nodiscard]] std::span<const std::uint32_t> references_in(const OctreeNode& leaf) const {
    return std::span(references).subspan(leaf.first, leaf.count);
  }
};

/// One eighth of a box: its upper half along axis i if bit i of the octant is set.
[[nodiscard]] Box octant_of(const Box& box, unsigned octant);

/// Builds the octree of a problem's discs. Throws Stopped if a stop was requested, and std::length_error, naming the
/// bytes, if the octree would not fit in memory.
[[nodiscard]] OctreeNodes build_octree(const Problem& problem, int depth, Insertion insertion,
                                       const std::stop_token& stop);

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
