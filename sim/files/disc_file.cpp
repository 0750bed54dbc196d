#include "disc_file.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "file_error.hpp"
#include "table.hpp"
#include "table_writer.hpp"

namespace detp::sim {

std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius, std::stop_token stop,
                             std::vector<std::string>* unused, const std::vector<ColumnName>& names) {
  std::vector<Disc> discs;
  KeptMemory memory(path);
  const ColumnChoice columns = ColumnChoice(disc_columns(default_radius)).named(names);
  read_table(
      path, columns, [&](const TableRow& row) { memory.push(discs, disc_in(row)); }, std::move(stop));
  if (discs.empty()) throw FileError(path, "has no disc; at least one is needed");
  if (unused != nullptr) *unused = columns.unused();
  return discs;
}

void write_discs(const std::string& path, const std::vector<Disc>& discs, const std::stop_token& stop,
                 std::span<const std::uint32_t> vertices) {
  std::vector<std::string_view> columns{"x", "y", "z", "nx", "ny", "nz", "radius"};
  if (!vertices.empty()) columns.emplace_back("vertex");
  TableWriter file(path, columns, discs.size(), "discs", stop);
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const auto& [c, n, radius] = discs[i];
    const double vertex = vertices.empty() || vertices[i] == no_vertex ? -1 : vertices[i];
    const std::array row{c.x, c.y, c.z, n.x, n.y, n.z, radius, vertex};
    file.write(std::span(row).first(columns.size()));
  }
  file.commit();
}

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

std::unique_ptr<const StoredDiscs> StoredDiscs::open(const std::string& path, std::optional<double> default_radius,
                                                     std::vector<std::string>* unused,
                                                     const std::vector<ColumnName>& names) {
  const ColumnChoice columns = ColumnChoice(disc_columns(default_radius)).named(names);
  auto file = TableFile::open(path, columns);
  if (!file) return nullptr;
  if (unused != nullptr) *unused = columns.unused();
  if (file->rows() == 0) throw FileError(path, "has no disc; at least one is needed");
  return std::unique_ptr<const StoredDiscs>(new StoredDiscs(std::move(*file)));
}

void StoredDiscs::read(std::uint64_t first, std::span<Disc> block, const std::stop_token& stop) const {
  constexpr std::size_t at_once = 1 << 12;
  sim::parallel_for(std::size_t{0}, (block.size() + at_once - 1) / at_once, [&](std::size_t part) {
    if (stop.stop_requested()) throw Stopped("stopped while reading " + shown_path(file_.path()));
    std::size_t next = part * at_once;
    const std::size_t last = std::min(block.size(), next + at_once);
    file_.read(first + next, first + last, [&](const TableRow& row) { block[next++] = disc_in(row); });
  });
}

}  // namespace detp::sim
