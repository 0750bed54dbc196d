#pragma once

#include <array>

#include "effect.hpp"

/// The effects. A new one is a file and a line in both lists below.
namespace detp::sim {

extern const Effect finite_paths;
extern const Effect surface_samples;
extern const Effect clustered_samples;
extern const Effect concave_surfaces;
extern const Effect uneven_rays;
extern const Effect occlusion;
extern const Effect directional_bias;
extern const Effect mixed_radii;
extern const Effect one_face;

/// In the order in which they are applied: uneven rays are those that finite paths and facing do not explain.
inline constexpr std::array all_effects{&one_face,         &surface_samples,  &clustered_samples,
                                        &concave_surfaces, &finite_paths,     &uneven_rays,
                                        &occlusion,        &directional_bias, &mixed_radii};

}  // namespace detp::sim
