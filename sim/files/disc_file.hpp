#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "detp/sim/geometry/disc_source.hpp"
#include "detp/sim/geometry/geometry.hpp"
#include "table.hpp"
#include "table_file.hpp"

namespace detp::sim {

/// Reads discs: CSV with the header x,y,z,nx,ny,nz and optionally radius and vertex, which is not used (columns in any order), or PLY with those
/// vertex properties. Normals are normalised.
///
/// default_radius is used if the column radius is missing, or a field of it is empty. Throws FileError with the line
/// (CSV) or the vertex's number (PLY) if the file is unreadable or malformed, or has no disc; for a number that is not
/// finite, a zero normal, a radius <= 0, or a missing radius without a default. Checks a row before it reads the next
/// row. `unused`, unless it is null, gets the columns that are none of a disc's. Throws std::length_error if the discs would not fit in memory, and Stopped within 0.1 s of a stop request.
[[nodiscard]] std::vector<Disc> read_discs(const std::string& path, std::optional<double> default_radius,
                                           std::stop_token stop = {}, std::vector<std::string>* unused = nullptr,
                                           const std::vector<ColumnName>& names = {});

/// Writes discs with the columns x,y,z,nx,ny,nz,radius, and vertex if there are vertices (-1: none), as CSV or PLY: table_writer.hpp. The same doubles are read back. Throws
/// FileError if the file cannot be written, and Stopped.
void write_discs(const std::string& path, const std::vector<Disc>& discs, const std::stop_token& stop = {},
                 std::span<const std::uint32_t> vertices = {});

// A disc as a row of a table.

/// Of a file of discs. `default_radius` is used if the column radius is missing, or a field of it is empty.
[[nodiscard]] std::vector<TableColumn> disc_columns(std::optional<double> default_radius);

/// Throws FileError with the row's place for a number that is not finite, a zero normal, and a radius <= 0. Normalises the normal.
[[nodiscard]] Disc disc_in(const TableRow& row);

/// The discs of a file, read block by block; nothing is kept in memory. A read throws FileError as read_discs does.
class StoredDiscs final : public DiscSource {
 public:
  /// Null if the rows of the file cannot be read in any order (TableFile::open). Reads the header alone. Throws FileError as read_discs does
  /// for a header.
  [[nodiscard]] static std::unique_ptr<const StoredDiscs> open(const std::string& path,
                                                               std::optional<double> default_radius,
                                                               std::vector<std::string>* unused = nullptr,
                                                               const std::vector<ColumnName>& names = {});

  [[nodiscard]] std::uint64_t size() const override { return file_.rows(); }
  /// Uses oneTBB's threads.
  void read(std::uint64_t first, std::span<Disc> block, const std::stop_token& stop = {}) const override;

 private:
  explicit StoredDiscs(TableFile file) : file_(std::move(file)) {}

  TableFile file_;
};

}  // namespace detp::sim
