#pragma once

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// The light of a mesh that brings none: an area light that shines straight down, against Y, whatever the mesh may be.
/// (No file of ours says which way is up. Y is what most renderers mean; in a mesh whose Z points up the light shines
/// from the side.)
///
/// It is half as wide as the box along X and along Z, over the box's middle, no edge shorter than 5 % of the box's
/// longest side. Where the box's height is below 5 % of its longest side the scene is a plane or flat land, and the
/// light hangs over it, at half the longest side. Else it hangs under the top of the box, inside: by 1 % of the box's
/// height, or by as many more (up to 20 %) as it takes to be under the ceiling of a room, not above or within it: most
/// of what falls from the light must then fall through half the box's height before it lands. If no height does that
/// (an object without a room around) it is 1 %.
///
/// The box is that of the used vertices; it must not be empty, nor a single point. Cost O(triangles). Throws
/// Stopped if a stop was requested.
[[nodiscard]] AreaLight light_for(const Mesh& mesh, const Box& box, const std::stop_token& stop = {});

}  // namespace detp::sim
