#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Reads discs: CSV with the header x,y,z,nx,ny,nz and optionally radius (columns in any order), or PLY with those
/// vertex properties. Normals are normalised.
///
/// default_radius serves where the file gives none. Throws FileError with the line (CSV) or the element's number (PLY):
/// unreadable or malformed, no disc at all, a number that is not finite, a zero normal, a radius <= 0 or none anywhere.
/// The first bad row is refused before the next is read. Throws std::length_error where the discs would not fit in
/// memory, and Stopped within 0.1 s of a stop request.
[[nodiscard]] std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius,
                                           std::stop_token stop = {});

/// Writes discs as CSV with the header x,y,z,nx,ny,nz,radius, in digits that read back to the same doubles.
void write_discs(const std::string& path, const std::vector<Disc>& discs, const std::stop_token& stop = {});

}  // namespace detp::sim
