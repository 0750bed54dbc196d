#include "disc_file.hpp"

#include <array>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "disc_row.hpp"
#include "file_error.hpp"
#include "table.hpp"
#include "table_writer.hpp"

namespace detp::sim {

std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius, std::stop_token stop) {
  std::vector<Disc> discs;
  KeptMemory memory(path);
  read_table(
      path, disc_columns(default_radius), [&](const TableRow& row) { memory.push(discs, disc_in(row)); },
      std::move(stop));
  if (discs.empty()) throw FileError(path, "has no disc; at least one is needed");
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

}  // namespace detp::sim
