#include "disc_row.hpp"

#include <fmt/format.h>

#include "detp/sim/geometry/unit_vector.hpp"

namespace detp::sim {
namespace disc_column {
enum Column : std::size_t { x, y, z, nx, ny, nz, radius };
}

std::vector<TableColumn> disc_columns(std::optional<double> default_radius) {
  return {{"x", {}, {}},
          {"y", {}, {}},
          {"z", {}, {}},
          {"nx", {}, {}},
          {"ny", {}, {}},
          {"nz", {}, {}},
          {"radius", default_radius, default_radius, ", and no default radius is given"},
          {"vertex", -1.0, -1.0}};
}

Disc disc_in(const TableRow& row) {
  using namespace disc_column;
  const Disc disc{
      .centre = row.finite_vector(x), .normal = unit_or_zero(row.finite_vector(nx)), .radius = row.finite(radius)};
  if (disc.normal == glm::dvec3{0.0}) row.fail("the normal is zero; it needs a length");
  if (disc.radius <= 0) row.fail(fmt::format("radius must be > 0 and finite (got {})", disc.radius));
  return disc;
}

}  // namespace detp::sim
