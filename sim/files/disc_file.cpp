#include "disc_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "disc_row.hpp"
#include "file_error.hpp"
#include "output_file.hpp"
#include "table.hpp"
#include "writing_check.hpp"

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
