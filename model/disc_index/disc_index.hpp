#pragma once

#include <functional>
#include <vector>

#include "detp/model/vocabulary/parameters.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"
#include "index_cells.hpp"

/// Index of discs, corrected: cubic cells, each with a reference to every disc that overlaps it.
///
/// The cells fill the samples' box grown by d on all sides; this larger box contains every disc. A ray enters cells
/// from outside, tests all discs referenced there, and may meet a disc in several cells. The expected number of convex
/// bodies that a random line meets is proportional to the sum of their surface areas, so for any structure
///
///     tests = n_R Σ_cells P(cell) references(cell) = n_R P(cell) n_P E
///     steps = n_R Σ_cells P(cell)        (a tree: nodes visited, summed over all its nodes)
///
///   where  P       crossing_probability of a cell (line_measure.hpp): for lines that hit a cube of 2^k cells along
///                  each side, Σ_cells P = 2^k and P = 1/4^k
///          E       expected number of cells that a disc overlaps
///
/// The paper's eq (22) differs: it multiplies the tests by the depth, and puts each disc in one cell (E = 1). Even a
/// plain octree has no factor log n_P: the nodes above the leaves only double the number of steps.
namespace detp::model {

/// Expected counts of octrees with empty nodes omitted, whose leaves all lie at one depth k. Returns the counts for
/// k = 0 … deepest.depth, all with the traversal of `deepest`.
///
///     disc_tests   n_R n_P E_k P_k;  with mailboxes n_R n_P P(at least one of the cells that a disc overlaps)
///     nodes        top-down, front-to-back  n_R Σ_{l=0..k} P_l O_l
///                  restart                  n_R [(k + 1) P_k O_k + Σ_{l=1..k} l P_l (8 O_{l-1} - O_l)]
///     placements   n_P Σ_{l=1..k} E_l
///
///   where  E_l, P_l   E and P(cell) for the cells of level l
///          O_l        occupied_cells of level l (index_cells.hpp). 8 O_{l-1} - O_l octants of this level are omitted;
///                     a descent to an omitted octant visits l nodes
///
/// Limits     no node empty: 2^{k+1} - 1 nodes per line top-down, (k + 1) 2^k with restarts (the paper's k 2^k does not
///            count the root).
/// Accuracy   per line that hits the cube, cases as in index_cells.hpp, 20 000 lines through S₀: nodes within 1.7 % for
///            top-down and restart (median 0.7 %). Disc tests for n_P 1e4 and 1e5 within 2.4 %, with mailboxes 2.1 %;
///            for n_P 1e3 up to 14 % off, where all lines make only a few hundred tests (median of all cases 0.7 %).
/// Throws     std::invalid_argument for a workload or depth out of range, and for neighbour links (no closed form).
[[nodiscard]] std::vector<Counts<double>> octree_counts_by_depth(const Valid<Workload>& workload,
                                                                 const OctreeParameters& deepest,
                                                                 const IndexVariant& variant = {});

/// Calls visit with these counts for k = 0, 1 … until visit returns false. Throws as octree_counts_by_depth does.
void for_each_octree_depth(const Valid<Workload>& workload, const OctreeParameters& deepest,
                           const IndexVariant& variant, const std::function<bool(const Counts<double>&)>& visit);

/// Expected counts of an octree of one depth. Throws as octree_counts_by_depth does.
[[nodiscard]] Counts<double> octree_counts(const Valid<Workload>& workload, const OctreeParameters& parameters,
                                           const IndexVariant& variant = {});

/// Expected counts of a uniform grid. Rays step through empty cells too.
///
///     steps   n_R 2 (m_1 L_2 L_3 + m_2 L_3 L_1 + m_3 L_1 L_2)/(4π r₀²)
///
///   where  m_i   cells along axis i;   L_i   side of the samples' box grown by d on both sides; rays are clipped to it
///
/// Accuracy   as for the octree; steps within 1.2 %.
/// Throws     std::invalid_argument for a workload or number of cells out of range.
[[nodiscard]] Counts<double> grid_counts(const Valid<Workload>& workload, const GridParameters& parameters,
                                         const IndexVariant& variant = {});

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
