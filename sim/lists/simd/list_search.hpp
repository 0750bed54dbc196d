#pragma once

#include <span>

#include "block_search.hpp"

/// Operations on one list with one sphere or one disc, compiled for each instruction set.
namespace detp::sim::stream {

/// Lists the rays of class k that may come within the sphere. `inside` must have room for all of `around`.
void cull_sphere(const BlockSearch& block, int k, const FloatSphere& sphere, const RayList& around, RayList& inside,
                 Worker& worker);

/// Finds the hits of the discs at places first … first + count - 1 by the listed rays of class k.
void test_discs(const BlockSearch& block, int k, std::uint32_t first, std::uint32_t count, const RayList& rays,
                Worker& worker);

/// Finds the hits of these discs by the listed rays of all classes, if these are needed at once (needs_all_classes). Also
/// counts visits and disc tests.
void test_all_classes(const BlockSearch& block, std::uint32_t first, std::uint32_t count, const RayLists& lists,
                      Worker& worker);

/// Finds the rays that hit the disc at this place, class by class, by their numbers in the block. Valid until the worker's next search.
/// Counts doubtful decisions.
[[nodiscard]] std::span<const std::uint32_t> find_rays(const BlockSearch& block, std::uint32_t place,
                                                       const RayLists& lists, Worker& worker);

// Culls lists of rays down a tree of boxes to its leaves' discs; compiled for each instruction set.

/// The rays that may meet the node's box: in the worker's arena, until the caller's scope ends.
[[nodiscard]] RayLists cull_node(const BlockSearch& block, const TreeNode& node, const RayLists& around,
                                 Worker& worker);

/// Searches everything below a node; `lists` are the node's lists. If a stop was requested, ends early and adds the
/// discs that were not searched to worker.skipped.
void search_below(const BlockSearch& block, const TreeNode& node, const RayLists& lists, Worker& worker);

/// The instruction set that the kernels use on this machine: "AVX3", …
[[nodiscard]] const char* instruction_set();

}  // namespace detp::sim::stream
