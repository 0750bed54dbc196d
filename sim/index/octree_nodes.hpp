#pragma once

#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/index_variant.hpp"
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

}  // namespace detp::sim
