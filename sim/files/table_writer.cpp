#include "table_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "file_error.hpp"
#include "npy_header.hpp"
#include "writing_check.hpp"

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
    std::vector<NpyColumn> fields;
    for (const std::string_view column : columns) fields.push_back({column});
    file_.write(npy_header(fields, rows));
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

namespace {

constexpr std::size_t longest = 5;

bool is_digit(char one) { return one >= '0' && one <= '9'; }

/// In lower case; 0 if it is no letter and no digit.
char in_lower_case(char one) {
  if (one >= 'A' && one <= 'Z') return static_cast<char>(one - 'A' + 'a');
  return (one >= 'a' && one <= 'z') || is_digit(one) ? one : '\0';
}

}  // namespace

std::string suffix_of(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0) return "";
  std::string suffix(name.substr(dot + 1));
  if (suffix.empty() || suffix.size() > longest || std::ranges::all_of(suffix, is_digit)) return "";
  std::ranges::transform(suffix, suffix.begin(), in_lower_case);
  return suffix.find('\0') == std::string::npos ? "." + suffix : "";
}

}  // namespace detp::sim
