#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Coordinates of some lines: all first ones, all second ones, and so on.
struct LineCoordinates {
  static constexpr std::size_t most = 64;
  alignas(64) std::array<std::array<double, most>, 4> of;
};

/// Writes line_at(sphere, coordinates) for the first lines: the same bits, several at a time. Up to LineCoordinates::most lines.
void write_lines(const Sphere& sphere, const LineCoordinates& coordinates, std::span<Ray> lines);

}  // namespace detp::sim
