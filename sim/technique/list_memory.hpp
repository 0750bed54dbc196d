#pragma once

#include "technique.hpp"

/// Predicted memory of techniques that cull lists of rays, beside rays, discs and pairs.
namespace detp::sim {

/// The nested lists of a walk: one a level.
struct NestedLists {
  double levels = 0;
  double rays = 0;  ///< rays in all lists inside the outermost, as a share of its own
};

/// Those of a sphere cache; of a ray field through all of S₀, a list's share of the rays is that of its sphere's
/// surface.
[[nodiscard]] NestedLists lists_of(const Problem& problem, const SphereCacheParameters& parameters);

/// Those of cell spheres, likewise.
[[nodiscard]] NestedLists lists_of(const Problem& problem, const CellSpheresParameters& parameters);

/// Bytes of a walk that has such lists, plainly or in floats.
[[nodiscard]] double walk_bytes(const Problem& problem, const RunOptions& options, const NestedLists& lists,
                                bool plain);

/// Bytes of a tree of spheres, which is always searched plainly.
[[nodiscard]] double sphere_tree_bytes(const Problem& problem, const RunOptions& options,
                                       const SphereTreeParameters& parameters);

}  // namespace detp::sim
