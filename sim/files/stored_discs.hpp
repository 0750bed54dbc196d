#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "detp/sim/geometry/disc_source.hpp"
#include "table_file.hpp"

namespace detp::sim {

/// The discs of a file, read block by block; nothing is kept in memory. A read throws FileError as read_discs does.
class StoredDiscs final : public DiscSource {
 public:
  /// Null if the rows of the file cannot be read in any order (TableFile::open). Reads the header alone. Throws FileError as read_discs does
  /// for a header.
  [[nodiscard]] static std::unique_ptr<const StoredDiscs> open(const std::string& path,
                                                               std::optional<double> default_radius);

  [[nodiscard]] std::uint64_t size() const override { return file_.rows(); }
  /// Uses oneTBB's threads.
  void read(std::uint64_t first, std::span<Disc> block, const std::stop_token& stop = {}) const override;

 private:
  explicit StoredDiscs(TableFile file) : file_(std::move(file)) {}

  TableFile file_;
};

}  // namespace detp::sim
