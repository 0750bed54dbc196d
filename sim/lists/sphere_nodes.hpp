#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/geometry.hpp"

/// A tree of nested spheres over the discs, independent of the rays.
namespace detp::sim {

/// Spheres over runs of consecutive discs.
///
/// Leaf j holds the discs order[j·leaf] … order[(j + 1)·leaf - 1]. Node j of any other level holds the nodes j·fan_out
/// … (j + 1)·fan_out - 1 of the level below. The last node of a level may hold fewer.
struct SphereTree {
  std::vector<std::vector<Sphere>> levels;  ///< the leaves first, the root last

  [[nodiscard]] std::size_t nodes() const;
};

/// Returns the tree over `discs`. `order` must contain each disc's number once.
///
/// A leaf's sphere contains its discs, any other sphere contains its children's spheres. So a list culled from the
/// parent's list lacks no ray of the child's sphere, and integral geometry gives the list's length. The tightest sphere
/// around a node's discs need not contain the children's spheres. (For fan-out 8, its area would be smaller by 10 %
/// one level above the leaves, and by 15 % higher up.) Rounding moves a sphere by a few ulp per level, less than the
/// slack.
///
/// A sphere's centre starts at the centre of the box around the centres of all its discs. It moves in six shrinking
/// steps, each towards the child (in a leaf, the disc) that reaches farthest from it. The smallest sphere on the way is
/// kept. The sum of all areas of a tree is 10 % less than without these steps and 1 % more than after twenty (10⁵
/// samples, fan-out 8).
///
/// Throws std::invalid_argument for parameters out of range, or if there is no disc; Stopped if a stop was requested.
[[nodiscard]] SphereTree make_sphere_tree(std::span<const Disc> discs, std::span<const std::uint32_t> order,
                                          const SphereTreeParameters& parameters, const std::stop_token& stop = {});

}  // namespace detp::sim
