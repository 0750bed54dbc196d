#pragma once

#include "detp/sim/lists/simd/ray_list.hpp"
#include "detp/sim/lists/sphere_nodes.hpp"
#include "detp/sim/search/outcome.hpp"
#include "detp/sim/search/problem.hpp"

/// Predicted memory of techniques that cull lists of rays, beside rays, discs and pairs.
///
/// How many rays a list holds is random. Predicted is what lines need, isotropic and uniform through all of S₀: a
/// list's share of them is that of its sphere's surface. Rays that crowd into one place need more.
namespace detp::sim {

/// The nested lists of a walk: one a level.
struct NestedLists {
  double levels = 0;
  double rays = 0;   ///< rays in all lists inside the outermost, as a share of its own
  double first = 0;  ///< the outermost's of these
  double last = 0;   ///< the innermost's

  [[nodiscard]] stream::ListRoom room() const { return {first, first + rays - last}; }
};

/// Those of a sphere cache.
[[nodiscard]] NestedLists lists_of(const Problem& problem, const SphereCacheParameters& parameters);

/// Those of cell spheres, likewise.
[[nodiscard]] NestedLists lists_of(const Problem& problem, const CellSpheresParameters& parameters);

/// Bytes of a walk that has such lists, plainly or in floats.
[[nodiscard]] double walk_bytes(const Problem& problem, const RunOptions& options, const NestedLists& lists,
                                bool plain);

/// Bytes of a plain search of lists, which inside the outermost hold so many times its rays: the discs' order, their
/// totals and outcome (or a copy of another's totals), the lists.
[[nodiscard]] double listing_bytes(const Problem& problem, const RunOptions& options, double nested);

/// Bytes while a tree of spheres is built, sorting before it included.
[[nodiscard]] double building_bytes(const Problem& problem, const SphereTreeParameters& parameters);

/// Bytes while it is searched, which is always done plainly.
[[nodiscard]] double searching_bytes(const Problem& problem, const RunOptions& options, const SphereTree& tree);

}  // namespace detp::sim
