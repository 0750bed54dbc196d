#pragma once

#include "block_search.hpp"

/// Culls lists of rays down a tree of boxes to its leaves' discs; compiled for each instruction set.
namespace detp::sim::stream {

/// Lists the rays that may meet the node's box. `inside` must have room for all of `around`.
void cull_node(const BlockSearch& block, const TreeNode& node, const RayLists& around, RayLists& inside,
               Worker& worker);

/// Searches everything below a node; `lists` are the node's lists. If a stop was requested, ends early and adds the
/// discs that were not searched to worker.skipped.
void search_below(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker);

/// The instruction set that the kernels use on this machine: "AVX3", …
[[nodiscard]] const char* instruction_set();

}  // namespace detp::sim::stream
