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

/// `count` discs at points uniform over a cube of that side around the origin, or over its faces, turned isotropically.
/// A function of the seed and each disc's number. Throws std::invalid_argument unless side and radius are > 0 and
/// finite, std::length_error where they would not fit the memory, and Stopped if a stop was requested.
[[nodiscard]] std::vector<Disc> uniform_discs(Body body, double side, std::size_t count, double radius,
                                              std::uint64_t seed, const std::stop_token& stop = {});

}  // namespace detp::sim
