#pragma once

#include "detp/model/vocabulary/index_variant.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

namespace detp::model {

/// Bytes of the parts of an index; the defaults are those of the simulation's indices.
struct IndexLayout {
  double node = 12;      ///< of an octree
  double cell = 8;       ///< of a grid: start of its references
  double reference = 4;  ///< of a disc
};

/// Expected bytes of memory of an octree, after it is built and before it is searched:
///
///     node Σ_{l=0..k} O_l + reference n_P E_k
///
///   where  O_l, E_k   occupied nodes of level l, cells that a disc overlaps (index_cells.hpp)
///
/// Accuracy   within 2.1 % of the measured bytes (median 0.3 %; cases as in index_cells.hpp).
///
/// Does not include neighbour links. Building needs up to twice these bytes, plus lists of the nodes being split.
/// Throws std::invalid_argument for a workload, parameters or a layout out of range.
[[nodiscard]] double octree_bytes(const Valid<Workload>& workload, const OctreeParameters& parameters,
                                  const IndexVariant& variant = {}, const IndexLayout& layout = {});

/// Expected bytes of a grid: cell (C + 1) + reference n_P E, where C is the number of cells. Building needs 16 n_P E
/// bytes more.
///
/// Accuracy   within 2 % of the measured bytes (median 0.1 %).
/// Throws     as octree_bytes does.
[[nodiscard]] double grid_bytes(const Valid<Workload>& workload, const GridParameters& parameters,
                                const IndexVariant& variant = {}, const IndexLayout& layout = {});

}  // namespace detp::model
