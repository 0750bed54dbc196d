#pragma once

#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "table.hpp"

/// A ray as a row of a table.
namespace detp::sim {

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
