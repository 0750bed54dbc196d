#pragma once

#include "block_search.hpp"

/// Lists of rays, culled down a tree of boxes to its leaves' discs: compiled for each instruction set.
namespace detp::sim::stream {

/// Lists those rays that may meet the node's box. `inside` must have room for all of `around`.
void cull_node(const BlockSearch& block, const TreeNode& node, const RayLists& around, RayLists& inside,
               Worker& worker);

/// Searches all that is below a node, whose lists these are. If a stop was requested, it ends early, and the discs not
/// searched are in worker.skipped.
void search_below(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker);

/// The instruction set that the kernels use here: "AVX3", …
[[nodiscard]] const char* instruction_set();

}  // namespace detp::sim::stream
