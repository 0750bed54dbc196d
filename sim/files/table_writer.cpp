#include "table_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "file_error.hpp"
#include "file_suffix.hpp"
#include "npy_header.hpp"
#include "ply_bytes.hpp"

namespace detp::sim {
namespace {

std::string format_suffix(const std::string& path) {
  std::string suffix = suffix_of(path);
  if (!suffix.empty() && suffix != ".csv" && suffix != ".ply" && suffix != ".npy")
    throw FileError(path, "cannot be written: its name must end in .csv, .ply or .npy, or have no suffix");
  return suffix.empty() ? ".csv" : suffix;
}

}  // namespace

TableWriter::TableWriter(const std::string& path, const std::vector<std::string_view>& columns, std::uint64_t rows,
                         const char* unit, const std::stop_token& stop)
    : suffix_(format_suffix(path)), check_(path, rows, unit, stop), file_(path, stop) {
  if (suffix_ == ".csv") {
    file_.write(fmt::format("{}\n", fmt::join(columns, ",")));
  } else if (suffix_ == ".npy") {
    file_.write(npy_header(columns, rows));
  } else {
    file_.write(fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", rows));
    for (const std::string_view column : columns) file_.write(fmt::format("property double {}\n", column));
    file_.write("end_header\n");
  }
}

void TableWriter::write(std::span<const double> row) {
  check_.next();
  if (suffix_ == ".csv") return file_.write(fmt::format("{}\n", fmt::join(row, ",")));
  for (const double number : row) write_little_endian(file_, number);
}

}  // namespace detp::sim
