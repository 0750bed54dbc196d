#pragma once

#include <functional>

#include "detp/model/vocabulary/index_variant.hpp"
#include "detp/sim/search/index.hpp"

/// The indices of discs behind the techniques octree, grid and bsp: in their variants, and as they stand when built.
namespace detp::sim {

/// A node of an octree or a BSP tree, or a cell of a grid.
struct IndexNode {
  Box box;  ///< where rays meet it; of a grid's outermost cells the part inside the grid's box
  int level = 0;
  bool leaf = false;
  std::size_t references = 0;  ///< discs listed here, in leaves
};

/// What an index holds.
struct IndexSize {
  std::size_t nodes = 0;  ///< of a tree, leaves included; of a grid its cells
  std::size_t references = 0;
  std::size_t placements = 0;  ///< discs found to overlap a cell or node, at all levels
  std::size_t bytes = 0;       ///< of memory, between building and searching
  double building_bytes = 0;   ///< predicted memory while it is built, at its peak
};

using VisitNode = std::function<void(const IndexNode&)>;

/// Builds an octree, needing no ray, and shows its nodes, parents before children.
/// Throws as run does for parameters out of range, and for an index that would not fit the memory; Stopped if a stop
/// was requested while it was built.
IndexSize inspect_octree(const Problem& problem, const OctreeParameters& parameters, const IndexVariant& variant,
                         const VisitNode& visit, const std::stop_token& stop = {});

/// The same for a grid: its cells, empty ones too.
IndexSize inspect_grid(const Problem& problem, const GridParameters& parameters, const IndexVariant& variant,
                       const VisitNode& visit, const std::stop_token& stop = {});

/// The same for a BSP tree, empty leaves too.
IndexSize inspect_bsp(const Problem& problem, const BspParameters& parameters, const VisitNode& visit,
                      const std::stop_token& stop = {});

/// Prepares a variant of the octree. All variants find the same hits. Throws as prepare does.
[[nodiscard]] std::unique_ptr<Index> index_octree(const Problem& problem, const OctreeParameters& parameters,
                                                  const IndexVariant& variant, const RunOptions& options = {});

/// Prepares a variant of the grid; there is only one way to walk it.
[[nodiscard]] std::unique_ptr<Index> index_grid(const Problem& problem, const GridParameters& parameters,
                                                const IndexVariant& variant, const RunOptions& options = {});

}  // namespace detp::sim
