#pragma once

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// The light of a mesh file, which has none of its own: an area light that shines straight down, against Y. (No
/// supported file format says which way is up. Most renderers mean Y. If a mesh's Z points up, the light shines from
/// the side.)
///
/// It is half as wide as the box along X and along Z, centred over the box; no edge is shorter than 5 % of the box's
/// longest side. If the box's height is below 5 % of its longest side, the scene is a plane or flat land, and the light
/// hangs over it at half the longest side. Otherwise the light hangs inside the box, 1 % of the box's height below its
/// top, or up to 20 % if it must go that far down to be below the ceiling of a room. It is below the ceiling if most
/// vertical drops from the light fall through half the box's height before they land. If no height meets this condition
/// (an object without a room around it), it is 1 %.
///
/// The box is that of the used vertices; it must not be empty, nor a single point. Cost O(triangles). Throws Stopped if
/// a stop was requested.
[[nodiscard]] AreaLight light_for(const Mesh& mesh, const Box& box, const std::stop_token& stop = {});

}  // namespace detp::sim
