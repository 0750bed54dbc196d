#include "disc_file.hpp"

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

enum Column : std::size_t { x, y, z, nx, ny, nz, radius };

Disc disc_in(const TableRow& row) {
  const Disc disc{
      .centre = row.finite_vector(x), .normal = unit_or_zero(row.finite_vector(nx)), .radius = row.finite(radius)};
  if (disc.normal == glm::dvec3{0.0}) row.fail("the normal is zero; it needs a length");
  if (disc.radius <= 0) row.fail(fmt::format("radius must be > 0 and finite (got {})", disc.radius));
  return disc;
}

}  // namespace

std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius, std::stop_token stop) {
  std::vector<Disc> discs;
  KeptMemory memory(path);
  read_table(
      path,
      {{"x", {}, {}},
       {"y", {}, {}},
       {"z", {}, {}},
       {"nx", {}, {}},
       {"ny", {}, {}},
       {"nz", {}, {}},
       {"radius", default_radius, default_radius, ", and no default radius is given"}},
      [&](const TableRow& row) { memory.push(discs, disc_in(row)); }, std::move(stop));
  if (discs.empty()) throw FileError(path, "has no disc; at least one is needed");
  return discs;
}

void write_discs(const std::string& path, const std::vector<Disc>& discs, const std::stop_token& stop) {
  WritingCheck check(path, discs.size(), "discs", stop);
  OutputFile file(path);
  file.write("x,y,z,nx,ny,nz,radius\n");
  for (const auto& [centre, normal, disc_radius] : discs) {
    check.next();
    file.write(
        fmt::format("{},{},{},{},{},{},{}\n", centre.x, centre.y, centre.z, normal.x, normal.y, normal.z, disc_radius));
  }
  file.commit();
}

}  // namespace detp::sim
