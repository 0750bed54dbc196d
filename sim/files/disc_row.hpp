#pragma once

#include <optional>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "table.hpp"

/// A disc as a row of a table.
namespace detp::sim {

/// Of a file of discs. `default_radius` is used if the column radius is missing, or a field of it is empty.
[[nodiscard]] std::vector<TableColumn> disc_columns(std::optional<double> default_radius);

/// Throws FileError with the row's place for a number that is not finite, a zero normal, and a radius <= 0. Normalises the normal.
[[nodiscard]] Disc disc_in(const TableRow& row);

}  // namespace detp::sim
