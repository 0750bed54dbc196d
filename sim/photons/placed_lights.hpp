#pragma once

#include <span>
#include <vector>

#include "detp/sim/scene/scene.hpp"
#include "detp/sim/scene/up.hpp"

namespace detp::sim {

/// The lights of these kinds at places that suit the mesh, for scenes whose files contain none. All but surface lights
/// share a flux of 1 evenly.
///
/// area         half as wide as the box along both horizontal axes, centred over the box, shining straight down; no
///              edge is shorter than 5 % of the box's longest side. If the box's height is below 5 % of its longest
///              side, the scene is a plane or flat land, and the light hangs over it at half the longest side.
///              Otherwise it hangs inside the box, 1 %, 2 %, ... or 20 % of the box's height below the top: at the first
///              of these heights from which most vertical lines run down at least half the box's height to the next
///              surface. So it hangs below a room's ceiling. If there is no such height (an object without a room
///              around it), it hangs at 1 %.
/// point, spot  in the middle of the area light; the spot shines straight down, into a cone of half angle 30 degrees.
/// directional  the sun: 37 degrees from straight down.
/// environment  the same radiance from all directions.
/// surface      the triangles whose material emits; its flux is theirs, in units of the file.
///
/// The box is that of the used vertices; it must not be empty, nor a single point. Cost O(triangles) per kind. Throws
/// Stopped if a stop was requested.
[[nodiscard]] std::vector<Light> placed_lights(std::span<const LightKind> kinds, const Mesh& mesh, const Box& box,
                                               const Up& up, const std::stop_token& stop = {});

}  // namespace detp::sim
