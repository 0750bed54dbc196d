#pragma once

#include <cstddef>
#include <vector>

#include "detp/validate/job/job.hpp"

/// The axes of a map: numbers of rays, and disc radii.
namespace detp::validate {

/// The most values of an axis. In a picture of 300 points, cells of a 40th of it are still visible.
inline constexpr std::size_t most_axis_values = 40;

struct MapAxes {
  std::vector<double> rays;   ///< numbers of rays; empty: as many as the file of rays has
  std::vector<Length> radii;  ///< empty: the radii of the file of discs
};

/// Half decades from 100 to 300 000.
[[nodiscard]] std::vector<double> default_map_rays();

/// 0.25 %, 0.5 %, … 16 % of the scene's longest side.
[[nodiscard]] std::vector<Length> default_map_radii();

/// The axes without repeated values, numbers of rays ascending. Throws std::invalid_argument for a number of rays that
/// is not a whole number from 1 to 1e18, and for a radius <= 0; std::length_error for more than most_axis_values
/// different values of an axis.
[[nodiscard]] MapAxes checked(MapAxes axes);

/// The edges of cells around ascending values > 0 on a logarithmic axis: the geometric means of neighbours. The first
/// and the last cell are symmetric. A single cell reaches from value/√10 to value·√10. One edge more than values.
[[nodiscard]] std::vector<double> cell_edges(const std::vector<double>& values);

}  // namespace detp::validate
