#pragma once

#include <cstring>
#include <span>
#include <string>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::support {

/// The content of a binary PLY file of discs, little-endian doubles.
inline std::string disc_ply(std::span<const sim::Disc> discs) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(discs.size()) + "\n";
  for (const char* const name : {"x", "y", "z", "nx", "ny", "nz", "radius"})
    text += std::string("property double ") + name + "\n";
  text += "end_header\n";
  for (const sim::Disc& disc : discs) {
    const double numbers[] = {disc.centre.x, disc.centre.y, disc.centre.z, disc.normal.x,
                              disc.normal.y, disc.normal.z, disc.radius};
    text.append(reinterpret_cast<const char*>(numbers), sizeof(numbers));
  }
  return text;
}

}  // namespace detp::support
