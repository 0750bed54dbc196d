#include "ray_row.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "detp/sim/geometry/unit_vector.hpp"

namespace detp::sim {
namespace {

constexpr double at_end = std::numeric_limits<double>::lowest();  ///< landing at the ray's end

}  // namespace

const std::vector<TableColumn>& ray_columns() {
  static const std::vector<TableColumn> columns{{"ox", {}, {}},
                                                {"oy", {}, {}},
                                                {"oz", {}, {}},
                                                {"dx", {}, {}},
                                                {"dy", {}, {}},
                                                {"dz", {}, {}},
                                                {"length", unbounded, unbounded},
                                                {"power", 1.0, {}},
                                                {"photon", 0.0, {}},
                                                {"landing", at_end, at_end}};
  return columns;
}

Ray ray_in(const TableRow& row) {
  const Ray ray{.origin = row.finite_vector(ray_column::ox),
                .direction = unit_or_zero(row.finite_vector(ray_column::dx)),
                .length = row[ray_column::length],
                .power = row.finite(ray_column::power)};
  if (ray.direction == glm::dvec3{0.0}) row.fail("the direction is zero; it needs a length");
  if (!(ray.length > 0)) row.fail(fmt::format("length must be > 0, or inf for a line (got {})", ray.length));
  if (ray.power < 0) row.fail(fmt::format("power must be >= 0 and finite (got {})", ray.power));
  return ray;
}

std::uint64_t photon_in(const TableRow& row) {
  constexpr double most = 0x1p53;
  const double number = row.finite(ray_column::photon);
  if (number < 0 || number > most || number != std::floor(number))
    row.fail(fmt::format("photon must be a whole number from 0 to 2^53 (got {})", number));
  return static_cast<std::uint64_t>(number);
}

double landing_in(const TableRow& row, const Ray& ray) {
  const double at = row[ray_column::landing];
  if (at == at_end) return ray.length;
  if (!(at >= 0)) row.fail(fmt::format("landing must be >= 0, or inf for none (got {})", at));
  return at;
}

}  // namespace detp::sim
