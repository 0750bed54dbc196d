#pragma once

#include "detp/sim/lists/simd/ray_list.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/problem.hpp"

/// Predicted memory of techniques that cull lists of rays, not including rays, discs and pairs.
///
/// The number of rays in a list is random. The prediction is for isotropic lines, uniform through all of S₀, the sphere
/// around all discs: a list's share of the lines is proportional to its sphere's surface. Rays that are concentrated in
/// one place need more.
namespace detp::sim {

/// The nested lists of a walk, one for each level.
struct NestedLists {
  double levels = 0;
  double rays = 0;   ///< rays in all lists inside the outermost, as a share of the outermost list
  double first = 0;  ///< rays in the first list inside the outermost, as a share of the outermost list
  double last = 0;   ///< rays in the innermost list, as a share of the outermost list

  [[nodiscard]] stream::ListCapacity capacity() const { return {first, rays}; }
};

/// The lists of a sphere cache.
[[nodiscard]] NestedLists lists_of(const Problem& problem, const SphereCacheParameters& parameters);

/// The lists of cell spheres.
[[nodiscard]] NestedLists lists_of(const Problem& problem, const CellSpheresParameters& parameters);

/// Bytes of a walk with nested lists, with the plain or the float engine.
[[nodiscard]] double walk_bytes(const Problem& problem, const RunOptions& options, const NestedLists& lists,
                                bool plain);

/// Bytes of a plain search of lists: the discs' order, their totals and outcome (or a copy of the caller's totals), and
/// the lists. All lists inside the outermost hold `nested` times as many rays as the outermost.
[[nodiscard]] double listing_bytes(const Problem& problem, const RunOptions& options, double nested);

/// Peak bytes while the discs are sorted and the sphere tree is built.
[[nodiscard]] double building_bytes(const Problem& problem, const SphereTreeParameters& parameters);

/// Bytes while a sphere tree is searched; the search is always plain.
[[nodiscard]] double searching_bytes(const Problem& problem, const RunOptions& options, const SphereTree& tree);

}  // namespace detp::sim
