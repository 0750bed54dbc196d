#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"

namespace detp::sim {

/// Reads discs: CSV with the header x,y,z,nx,ny,nz and optionally radius and vertex, which is not used (columns in any order), or PLY with those
/// vertex properties. Normals are normalised.
///
/// default_radius is used if the column radius is missing, or a field of it is empty. Throws FileError with the line
/// (CSV) or the vertex's number (PLY) if the file is unreadable or malformed, or has no disc; for a number that is not
/// finite, a zero normal, a radius <= 0, or a missing radius without a default. Checks a row before it reads the next
/// row. Throws std::length_error if the discs would not fit in memory, and Stopped within 0.1 s of a stop request.
[[nodiscard]] std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius,
                                           std::stop_token stop = {});

/// Writes discs with the columns x,y,z,nx,ny,nz,radius, and vertex if there are vertices (-1: none), as CSV or PLY: table_writer.hpp. The same doubles are read back. Throws
/// FileError if the file cannot be written, and Stopped.
void write_discs(const std::string& path, const std::vector<Disc>& discs, const std::stop_token& stop = {},
                 std::span<const std::uint32_t> vertices = {});

}  // namespace detp::sim
