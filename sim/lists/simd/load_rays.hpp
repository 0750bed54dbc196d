#pragma once

#include <optional>

#include "ray_list.hpp"

namespace detp::sim::stream {

/// Common properties of rays.
struct RayTraits {
  bool segments = false;        ///< at least one of them ends
  std::optional<double> power;  ///< the power of all rays, if it is the same
};

/// Converts rays to the frame's coordinates and sorts them by class; their numbers start at 0. Rays that miss S₀ are
/// left out. There must be at least one ray, and at most 2³¹. The lists must be empty and have room for all rays in
/// each class, including ends.
RayTraits load_rays(std::span<const Ray> rays, const Frame& frame, RayLists& lists);

}  // namespace detp::sim::stream
