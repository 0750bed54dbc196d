#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Reads rays: CSV with the header ox,oy,oz,dx,dy,dz and optionally length and power (columns in any order), or PLY
/// with those vertex properties. Directions are normalised (the length is not scaled: it is a length in scene units).
///
/// length: absent, empty or "inf" means the line unbounded both ways; else > 0 and finite: the segment from the origin.
/// power: absent means 1; else finite and >= 0. Throws FileError as read_discs does; a zero direction is an error.
[[nodiscard]] std::vector<Ray> read_rays(const std::string& path, std::stop_token stop = {});

/// Writes rays as CSV with the header ox,oy,oz,dx,dy,dz,length,power, in digits that read back to the same doubles.
void write_rays(const std::string& path, const std::vector<Ray>& rays, const std::stop_token& stop = {});

}  // namespace detp::sim
