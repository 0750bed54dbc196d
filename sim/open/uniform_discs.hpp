#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Where uniform samples lie.
enum class Body {
  cube,       ///< in the volume of the cube
  cube_faces  ///< on its six faces
};

/// `count` discs at uniform points in a cube of side `side` around the origin, or on its faces, with isotropic normals.
/// Each disc is a function of the seed and of its number. Throws std::invalid_argument unless side and radius are > 0
/// and finite, std::length_error if the discs would not fit in memory, and Stopped if a stop was requested.
[[nodiscard]] std::vector<Disc> uniform_discs(Body body, double side, std::size_t count, double radius,
                                              std::uint64_t seed, const std::stop_token& stop = {});

}  // namespace detp::sim
