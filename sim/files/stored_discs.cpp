#include "stored_discs.hpp"

#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stopped.hpp"
#include "disc_row.hpp"
#include "file_error.hpp"

namespace detp::sim {

std::unique_ptr<const StoredDiscs> StoredDiscs::open(const std::string& path, std::optional<double> default_radius) {
  auto file = TableFile::open(path, disc_columns(default_radius));
  if (!file) return nullptr;
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
