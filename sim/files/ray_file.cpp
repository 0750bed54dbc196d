#include "ray_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/geometry/unit_vector.hpp"
#include "file_error.hpp"
#include "output_file.hpp"
#include "table.hpp"
#include "writing_check.hpp"

namespace detp::sim {
namespace {

enum Column : std::size_t { ox, oy, oz, dx, dy, dz, length, power };

Ray ray_in(const TableRow& row) {
  const Ray ray{.origin = row.finite_vector(ox),
                .direction = unit_or_zero(row.finite_vector(dx)),
                .length = row[length],
                .power = row.finite(power)};
  if (ray.direction == glm::dvec3{0.0}) row.fail("the direction is zero; it needs a length");
  if (!(ray.length > 0)) row.fail(fmt::format("length must be > 0, or inf for a line (got {})", ray.length));
  if (ray.power < 0) row.fail(fmt::format("power must be >= 0 and finite (got {})", ray.power));
  return ray;
}

}  // namespace

std::vector<Ray> read_rays(const std::string& path, std::stop_token stop) {
  std::vector<Ray> rays;
  KeptMemory memory(path);
  read_table(
      path,
      {{"ox", {}, {}},
       {"oy", {}, {}},
       {"oz", {}, {}},
       {"dx", {}, {}},
       {"dy", {}, {}},
       {"dz", {}, {}},
       {"length", unbounded, unbounded},
       {"power", 1.0, {}}},
      [&](const TableRow& row) { memory.push(rays, ray_in(row)); }, std::move(stop));
  if (rays.empty()) throw FileError(path, "has no ray; at least one is needed");
  return rays;
}

void write_rays(const std::string& path, const std::vector<Ray>& rays, const std::stop_token& stop) {
  WritingCheck check(path, rays.size(), "rays", stop);
  OutputFile file(path);
  file.write("ox,oy,oz,dx,dy,dz,length,power\n");
  for (const auto& [origin, direction, ray_length, ray_power] : rays) {
    check.next();
    file.write(fmt::format("{},{},{},{},{},{},{},{}\n", origin.x, origin.y, origin.z, direction.x, direction.y,
                           direction.z, ray_length, ray_power));
  }
  file.commit();
}

}  // namespace detp::sim
