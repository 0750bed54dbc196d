#pragma once

#include "detp/sim/scene/scene.hpp"

namespace detp::sim {

/// The light of a mesh file, since files contain no light: an area light that shines straight down, against Y. (No
/// supported file format says which way is up. Most renderers mean Y. If a mesh's Z points up, the light shines from
/// the side.)
///
/// The light is half as wide as the box along X and along Z, and centred over the box; no edge is shorter than 5 % of
/// the box's longest side. If the box's height is below 5 % of its longest side, the scene is a plane or flat land, and
/// the light hangs over it at half the longest side. Otherwise the light hangs inside the box, 1 %, 2 %, … or 20 % of
/// the box's height below the top: at the first of these heights from which most vertical lines run down at least half
/// the box's height to the next surface. So it hangs below a room's ceiling. If there is no such height (an object
/// without a room around it), the light hangs at 1 %.
///
/// The box is that of the used vertices; it must not be empty, nor a single point. Cost O(triangles). Throws Stopped if
/// a stop was requested.
[[nodiscard]] AreaLight light_for(const Mesh& mesh, const Box& box, const std::stop_token& stop = {});

}  // namespace detp::sim
