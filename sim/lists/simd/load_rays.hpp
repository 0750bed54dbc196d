#pragma once

#include <optional>

#include "ray_list.hpp"

namespace detp::sim::stream {

/// What is common to rays.
struct RayTraits {
  bool segments = false;        ///< one of them ends
  std::optional<double> power;  ///< what all carry, if it is the same
};

/// Rays in the frame's coordinates, by class; numbered from the first of them. Rays that pass S₀ are left out. At least
/// one ray, and 2³¹ at most. The lists must be empty and have room for all rays in each class, ends too.
RayTraits load_rays(std::span<const Ray> rays, const Frame& frame, RayLists& lists);

}  // namespace detp::sim::stream
