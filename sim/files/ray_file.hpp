#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Reads rays: CSV with the header ox,oy,oz,dx,dy,dz and optionally length and power (columns in any order), or PLY
/// with those vertex properties. Directions are normalised. Lengths are in scene units, so normalising leaves them
/// unchanged.
///
/// length: absent, empty or "inf" means a line unbounded both ways. Any other length must be > 0, and the ray is the
/// segment from the origin. power: absent means 1. A given power must be finite and >= 0. Throws FileError as
/// read_discs does, and for a zero direction.
[[nodiscard]] std::vector<Ray> read_rays(const std::string& path, std::stop_token stop = {});

/// Writes rays as CSV with the header ox,oy,oz,dx,dy,dz,length,power, with enough digits to read back the same doubles.
/// Throws FileError if the file cannot be written, and Stopped.
void write_rays(const std::string& path, const std::vector<Ray>& rays, const std::stop_token& stop = {});

}  // namespace detp::sim
