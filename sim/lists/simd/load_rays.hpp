#pragma once

#include <optional>

#include "ray_list.hpp"

namespace detp::sim::stream {

/// Common properties of rays.
struct RayTraits {
  bool segments = false;        ///< at least one ray is a segment
  std::optional<double> power;  ///< the power of each ray, if all powers are equal
};

/// Converts rays to the frame's coordinates and sorts them by class; their numbers start at 0. Leaves out rays that
/// stay far from S₀. There must be at least one ray, and at most 2³¹. Each list must be empty and have room for all
/// rays and their ends. Fills the padding behind each list with zeros: the kernels compute with it, and whatever is in
/// reused memory may be subnormal numbers, with which a test of few rays takes ten times as long.
RayTraits load_rays(std::span<const Ray> rays, const Frame& frame, RayLists& lists);

}  // namespace detp::sim::stream
