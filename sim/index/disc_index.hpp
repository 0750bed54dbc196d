#pragma once

#include <functional>

#include "detp/model/vocabulary/parameters.hpp"
#include "detp/sim/search/index.hpp"

/// The indices of discs behind the techniques octree, grid and bsp: their variants, and access to the built index.
namespace detp::sim {

/// A node of an octree or a BSP tree, or a cell of a grid.
struct IndexNode {
  Box box;  ///< the node's box; a grid's outermost cells are clipped to the grid's box
  int level = 0;
  bool leaf = false;
  std::size_t references = 0;  ///< number of discs listed here; 0 for inner nodes
};

/// The size of an index.
struct IndexSize {
  std::size_t nodes = 0;  ///< nodes of a tree including leaves, or cells of a grid
  std::size_t references = 0;
  std::size_t placements = 0;  ///< insertions of a disc into a cell or node, at all levels
  std::size_t bytes = 0;       ///< bytes of memory after building and before searching
  double building_bytes = 0;   ///< predicted peak memory while it is built
};

using VisitNode = std::function<void(const IndexNode&)>;

/// Builds an octree, calls `visit` for each of its nodes (parents before children) and returns its size. The problem
/// needs no rays. Throws as run does if a parameter is out of range or the octree would not fit in memory, and Stopped
/// if a stop was requested during the build.
IndexSize inspect_octree(const Problem& problem, const OctreeParameters& parameters, const IndexVariant& variant,
                         const VisitNode& visit, const std::stop_token& stop = {});

/// Builds a grid, calls `visit` for each of its cells, including empty ones, and returns its size. Throws as
/// inspect_octree does.
IndexSize inspect_grid(const Problem& problem, const GridParameters& parameters, const IndexVariant& variant,
                       const VisitNode& visit, const std::stop_token& stop = {});

/// Builds a BSP tree, calls `visit` for each of its nodes, including empty leaves, and returns its size. Throws as
/// inspect_octree does.
IndexSize inspect_bsp(const Problem& problem, const BspParameters& parameters, const VisitNode& visit,
                      const std::stop_token& stop = {});

/// Prepares a variant of the octree. All variants find the same hits. Throws as prepare does.
[[nodiscard]] std::unique_ptr<Index> index_octree(const Problem& problem, const OctreeParameters& parameters,
                                                  const IndexVariant& variant, const RunOptions& options = {});

/// Prepares a variant of the grid. There is only one way to traverse a grid. Throws as prepare does.
[[nodiscard]] std::unique_ptr<Index> index_grid(const Problem& problem, const GridParameters& parameters,
                                                const IndexVariant& variant, const RunOptions& options = {});

}  // namespace detp::sim
