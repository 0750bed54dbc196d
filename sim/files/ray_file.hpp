#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "detp/sim/geometry/paths.hpp"
#include "table.hpp"

namespace detp::sim {

/// A band of powers, and the column of a file that has it.
struct BandColumn {
  std::string name;
  std::string column;

  bool operator==(const BandColumn&) const = default;
};

/// Which columns of a file of rays are what.
struct RayColumns {
  std::vector<BandColumn> bands = {};  ///< none: power, or power_NAME
  std::vector<ColumnName> names = {};
};

/// The columns of a file of rays, with those of bands: power, or power_NAME for each of some bands, or the columns that are asked for. A
/// name has 1 to 64 letters, digits, dots, minuses and underscores. The choice throws FileError for a file with power and power_NAME, for names
/// that appear twice, and for more than 64 bands. `found`, which must outlive the choice, gets the bands in the order of the file; none: power.
[[nodiscard]] ColumnChoice ray_columns(const RayColumns& asked, std::vector<BandColumn>& found);

/// Reads "r=red,g=green". Throws std::invalid_argument for anything else, and as ray_columns for the names.
[[nodiscard]] std::vector<BandColumn> parse_bands(std::string_view text);

/// Whether a file of rays can have a column of this name; else a file of discs may.
[[nodiscard]] bool is_ray_column(std::string_view name);

/// Rays as a file has them.
struct RayFile {
  Paths paths;
  std::vector<BandColumn> bands = {};  ///< empty: one power without a name
  /// Number in the file of each ray; empty if the rays have the file's order.
  std::vector<std::uint32_t> order = {};
  std::vector<std::string> unused = {};  ///< columns of the file that are none of a ray's
};

/// Reads rays: CSV with the header ox,oy,oz,dx,dy,dz and optionally length, power (or powers in bands: ray_columns), photon and landing (columns in any order),
/// or PLY with those vertex properties. Directions are normalised. Lengths are in scene units, so normalising leaves them
/// unchanged.
///
/// length: absent, empty or "inf" means a line unbounded both ways. Any other length must be > 0, and the ray is the
/// segment from the origin. power: absent means 1. A given power must be finite and >= 0. photon: a whole number that the
/// rays of one photon's path share; absent: each ray is a photon of its own. Rays of a photon that are apart in the file are
/// brought together, behind its first ray. landing: distance to the surface that the photon met, "inf" if it met none; absent
/// or empty: the ray's end. Throws FileError as read_discs does, and for a zero direction, a photon that is no whole number
/// from 0 to 2^53, and a landing < 0.
[[nodiscard]] RayFile read_rays(const std::string& path, std::stop_token stop = {}, const RayColumns& asked = {});

/// Writes rays with the columns ox,oy,oz,dx,dy,dz,length,power (of bands with names power_NAME), and photon and landing if the paths have them, as CSV or PLY:
/// table_writer.hpp. The same doubles are read back. Throws FileError if the file cannot be written, and Stopped.
void write_rays(const std::string& path, const PathRays& paths, const std::stop_token& stop = {},
                const std::vector<std::string>& bands = {});

// A ray as a row of a table.

namespace ray_column {
/// Further bands follow.
enum Column : std::size_t { ox, oy, oz, dx, dy, dz, length, power, photon, landing, further };
}  // namespace ray_column

/// Throw FileError with the row's place.
[[nodiscard]] double power_in(const TableRow& row, std::size_t column);
[[nodiscard]] Ray ray_in(const TableRow& row);
[[nodiscard]] std::uint64_t photon_in(const TableRow& row);
[[nodiscard]] double landing_in(const TableRow& row, const Ray& ray);

}  // namespace detp::sim
