#pragma once

#include "detp/model/vocabulary.hpp"
#include "detp/sim/technique/technique.hpp"

/// What a built index of discs says of its own search, before any ray.
namespace detp::validate {

/// Expected counts of an octree, a grid or a BSP tree on isotropic lines through S₀:
///
///     nodes or steps = n_R Σ P(node)        disc_tests = n_R Σ_leaves P(leaf) references(leaf)
///     P(node) = F(node)/(4π r₀²) × share of the lines through the node that also cross S₀
///
///   where  F   surface area of the node, or of the part of a grid's cell inside the grid's box
///
/// The share is 1 for a node inside S₀. For one that pokes out it is integrated over a few lines of a fixed pool laid
/// through the node: the more lines, the larger the node. References and placements are exact.
///
/// Source     eq (3), summed over the structure: the surface-area heuristic.
/// Valid      lines of the measure μ_ℓ through S₀; discs of any radii.
/// Throws     std::invalid_argument for a technique without an index, and for an octree whose nodes are not visited
/// once
///            each (restart, neighbour links); as sim::run does for parameters out of range and
///            for an index that would not fit the memory.
[[nodiscard]] Counts<double> structural_index_counts(const sim::Problem& problem, double rays,
                                                     const Candidate& candidate, const std::stop_token& stop = {});

}  // namespace detp::validate
