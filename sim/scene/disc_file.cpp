#include "disc_file.hpp"

#include <fmt/format.h>

#include "file_error.hpp"
#include "output_file.hpp"
#include "table.hpp"
#include "unit_vector.hpp"

namespace detp::sim {
namespace {

enum Column : std::size_t { x, y, z, nx, ny, nz, radius };

Disc disc_in(const Table& table, std::size_t row) {
  const Disc disc{.centre = table.finite_vector(row, x),
                  .normal = unit_or_zero(table.finite_vector(row, nx)),
                  .radius = table.finite(row, radius)};
  if (disc.normal == glm::dvec3{0.0}) table.fail(row, "the normal is zero; it needs a length");
  if (disc.radius <= 0) table.fail(row, fmt::format("radius must be > 0 and finite (got {})", disc.radius));
  return disc;
}

}  // namespace

std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius) {
  const Table table =
      read_table(path, {{"x", {}, {}},
                        {"y", {}, {}},
                        {"z", {}, {}},
                        {"nx", {}, {}},
                        {"ny", {}, {}},
                        {"nz", {}, {}},
                        {"radius", default_radius, default_radius, ", and no default radius is given"}});
  if (table.rows == 0) throw FileError(path, "holds no disc; at least one is needed");
  std::vector<Disc> discs;
  discs.reserve(table.rows);
  for (std::size_t row = 0; row < table.rows; ++row) discs.push_back(disc_in(table, row));
  return discs;
}

void write_discs(const std::string& path, const std::vector<Disc>& discs) {
  OutputFile file(path);
  file.write("x,y,z,nx,ny,nz,radius\n");
  for (const auto& [centre, normal, disc_radius] : discs)
    file.write(
        fmt::format("{},{},{},{},{},{},{}\n", centre.x, centre.y, centre.z, normal.x, normal.y, normal.z, disc_radius));
  file.commit();
}

}  // namespace detp::sim
