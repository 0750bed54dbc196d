#include "ray_file.hpp"

#include <fmt/format.h>

#include "file_error.hpp"
#include "output_file.hpp"
#include "table.hpp"
#include "unit_vector.hpp"

namespace detp::sim {
namespace {

enum Column : std::size_t { ox, oy, oz, dx, dy, dz, length, power };

Ray ray_in(const Table& table, std::size_t row) {
  const Ray ray{.origin = table.finite_vector(row, ox),
                .direction = unit_or_zero(table.finite_vector(row, dx)),
                .length = table.values[length][row],
                .power = table.finite(row, power)};
  if (ray.direction == glm::dvec3{0.0}) table.fail(row, "the direction is zero; it needs a length");
  if (!(ray.length > 0)) table.fail(row, fmt::format("length must be > 0, or inf for a line (got {})", ray.length));
  if (ray.power < 0) table.fail(row, fmt::format("power must be >= 0 and finite (got {})", ray.power));
  return ray;
}

}  // namespace

std::vector<Ray> read_rays(const std::string& path) {
  const Table table = read_table(path, {{"ox", {}, {}},
                                        {"oy", {}, {}},
                                        {"oz", {}, {}},
                                        {"dx", {}, {}},
                                        {"dy", {}, {}},
                                        {"dz", {}, {}},
                                        {"length", unbounded, unbounded},
                                        {"power", 1.0, {}}});
  if (table.rows == 0) throw FileError(path, "holds no ray; at least one is needed");
  std::vector<Ray> rays;
  rays.reserve(table.rows);
  for (std::size_t row = 0; row < table.rows; ++row) rays.push_back(ray_in(table, row));
  return rays;
}

void write_rays(const std::string& path, const std::vector<Ray>& rays) {
  OutputFile file(path);
  file.write("ox,oy,oz,dx,dy,dz,length,power\n");
  for (const auto& [origin, direction, ray_length, ray_power] : rays)
    file.write(fmt::format("{},{},{},{},{},{},{},{}\n", origin.x, origin.y, origin.z, direction.x, direction.y,
                           direction.z, ray_length, ray_power));
  file.commit();
}

}  // namespace detp::sim
