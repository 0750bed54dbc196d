#pragma once

#include "disc_tree.hpp"
#include "detp/sim/technique/totals.hpp"
#include "ray_list.hpp"

/// Lists of rays, culled down a tree of boxes to its leaves' discs: compiled for each instruction set.
namespace detp::sim::stream {

/// Hits of one disc by rays of each class.
using ClassCounts = std::array<std::uint32_t, classes + 1>;

/// What all threads read while a block of rays is searched for.
struct BlockSearch {
  const Problem& problem;
  const Frame& frame;
  const DiscTree& tree;
  std::uint32_t first_ray;  ///< the block's
  bool segments;            ///< its lists tell where rays end
  bool pairs;               ///< wanted
  ClassCounts* counted;     ///< in the tree's order: where hits are only counted; else null, and it is the totals
  DiscTotals* totals;       ///< that grow. Either's elements are written by one thread each
  std::stop_token stop;
};

/// What one thread has of its own.
struct Worker {
  ListArena lists;
  std::vector<Pair> pairs;
  Counts<std::uint64_t> counts;
};

/// Lists those rays that may meet the node's box. `inside` must have room for all of `around`.
void cull_node(const BlockSearch& block, const TreeNode& node, const RayLists& around, RayLists& inside, Worker& worker);

/// Searches all that is below a node, whose lists these are. Asks for a stop now and then: then it leaves off early.
void search_below(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker);

/// The instruction set that the kernels use here: "AVX3", …
[[nodiscard]] const char* instruction_set();

}  // namespace detp::sim::stream
