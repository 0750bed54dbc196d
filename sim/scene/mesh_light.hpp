#pragma once

#include "scene.hpp"

namespace detp::sim {

/// The light of a mesh that brings none: an area light that shines straight down, against Y, whatever the mesh may be.
/// (No file of ours says which way is up. Y is what most renderers mean; in a mesh whose Z points up the light shines
/// from the side.)
///
/// It is half as wide as the box along X and along Z, over the box's middle, and hangs 1 % of the box's height under
/// the top: in a closed room, under the ceiling. Where the box's height is below 5 % of its longest side the scene is a
/// plane or flat land, and the light hangs over it, at half the longest side. No edge of the light is shorter than 5 %
/// of the box's longest side.
/// The box must not be empty, nor a single point.
[[nodiscard]] AreaLight light_for(const Box& box);

}  // namespace detp::sim
