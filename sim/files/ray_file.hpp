#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/geometry/paths.hpp"
#include "table.hpp"

namespace detp::sim {

/// Rays as a file has them.
struct RayFile {
  Paths paths;
  /// Number in the file of each ray; empty if the rays have the file's order.
  std::vector<std::uint32_t> order = {};
};

/// Reads rays: CSV with the header ox,oy,oz,dx,dy,dz and optionally length, power, photon and landing (columns in any order),
/// or PLY with those vertex properties. Directions are normalised. Lengths are in scene units, so normalising leaves them
/// unchanged.
///
/// length: absent, empty or "inf" means a line unbounded both ways. Any other length must be > 0, and the ray is the
/// segment from the origin. power: absent means 1. A given power must be finite and >= 0. photon: a whole number that the
/// rays of one photon's path share; absent: each ray is a photon of its own. Rays of a photon that are apart in the file are
/// brought together, behind its first ray. landing: distance to the surface that the photon met, "inf" if it met none; absent
/// or empty: the ray's end. Throws FileError as read_discs does, and for a zero direction, a photon that is no whole number
/// from 0 to 2^53, and a landing < 0.
[[nodiscard]] RayFile read_rays(const std::string& path, std::stop_token stop = {});

/// Writes rays with the columns ox,oy,oz,dx,dy,dz,length,power, and photon and landing if the paths have them, as CSV or PLY:
/// table_writer.hpp. The same doubles are read back. Throws FileError if the file cannot be written, and Stopped.
void write_rays(const std::string& path, const PathRays& paths, const std::stop_token& stop = {});

// A ray as a row of a table.

namespace ray_column {
enum Column : std::size_t { ox, oy, oz, dx, dy, dz, length, power, photon, landing };
}

/// Of a file of rays.
[[nodiscard]] const std::vector<TableColumn>& ray_columns();

/// Throw FileError with the row's place.
[[nodiscard]] Ray ray_in(const TableRow& row);
[[nodiscard]] std::uint64_t photon_in(const TableRow& row);
[[nodiscard]] double landing_in(const TableRow& row, const Ray& ray);

}  // namespace detp::sim
