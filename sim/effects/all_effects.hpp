#pragma once

#include <array>

#include "effect.hpp"

/// The effects, one in each source file. A new one is a file and a line in both lists below.
namespace detp::sim {

extern const Effect finite_paths;
extern const Effect surface_samples;
extern const Effect far_samples;
extern const Effect mixed_radii;
extern const Effect one_face;

/// In the order in which they are applied: far samples need to know whether paths are finite.
inline constexpr std::array all_effects{&finite_paths, &surface_samples, &far_samples, &mixed_radii, &one_face};

}  // namespace detp::sim
