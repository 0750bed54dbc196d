#include "table_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/stopped.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "npy_header.hpp"
#include "number_bytes.hpp"

namespace detp::sim {
namespace {

std::size_t size_of_row(const PlyElement& element) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties) size += size_of(property.type);
  return size;
}

std::string names_of(const std::vector<TableColumn>& columns) {
  std::vector<std::string_view> names;
  for (const TableColumn& column : columns) names.push_back(column.name);
  return fmt::format("{}", fmt::join(names, ","));
}

bool has_list(const PlyElement& element) {
  return std::ranges::any_of(element.properties, [](const PlyProperty& one) { return one.count_type.has_value(); });
}

}  // namespace

std::optional<TableFile> TableFile::open(const std::string& path, const ColumnChoice& choice) {
  const bool is_npy = has_ending(path, ".npy");
  if (!is_npy && !has_ending(path, ".ply")) return std::nullopt;
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) {  // a pipe is read once
    if (is_npy && std::filesystem::exists(path, unknown)) throw FileError(path, "is no regular file; .npy needs one");
    if (!is_npy) return std::nullopt;
  }
  InputFile file(path);
  TableFile table(path);
  if (is_npy)
    table.take_npy(file, choice);
  else if (!table.take_ply(file, choice))
    return std::nullopt;
  return table;
}

bool TableFile::take_ply(InputFile& file, const ColumnChoice& choice) {
  const PlyHeader header = read_ply_header(file);
  if (header.format == PlyFormat::ascii || !file.rest()) return false;
  const bool swapped = (header.format == PlyFormat::little_endian) != (std::endian::native == std::endian::little);
  std::uint64_t before = 0;  // bytes of the elements before the vertices
  const PlyElement& rows = element_of_rows(path_, header.elements);
  for (const PlyElement* element = header.elements.data(); element <= &rows; ++element) {
    if (has_list(*element)) return false;
    if (element != &rows) before += element->rows * size_of_row(*element);
  }
  rows_ = rows.rows;
  row_size_ = size_of_row(rows);
  row_name_ = rows.name;
  const std::vector<std::string> names = choice.known(path_, rows.names());
  columns_ = choice(path_, names);
  choice.sort_out(path_, names, columns_);
  for (const TableColumn& column : columns_) {
    auto& place = places_.emplace_back();
    if (const auto property = rows.number(column.name, names)) {
      place.emplace(Place{0, rows.properties[*property].type, swapped});
      for (std::size_t i = 0; i < *property; ++i) place->offset += size_of(rows.properties[i].type);
    } else if (!column.absent) {
      throw FileError(path_, fmt::format("its element {} has no property {}{}", rows.name, column.name, column.remedy));
    }
  }
  open_rows(*file.rest(), before, "rows of element " + rows.name);
  return true;
}

void TableFile::take_npy(InputFile& file, const ColumnChoice& choice) {
  const NpyHeader header = read_npy_header(file);
  rows_ = header.rows;
  row_size_ = header.row_size;
  row_name_ = "row";
  bool plain = std::ranges::all_of(header.fields, [](const NpyField& one) { return one.name.empty(); });
  std::vector<std::string> names = plain ? choice.numbered(header.fields.size()) : std::vector<std::string>{};
  if (!plain)
    for (const NpyField& field : header.fields) names.push_back(field.name);
  names = choice.known(path_, std::move(names));
  plain = names.empty();
  columns_ = choice(path_, names);
  choice.sort_out(path_, names, columns_);
  if (plain && header.fields.size() > columns_.size())
    throw FileError(path_, fmt::format("has {} columns; known are {}", header.fields.size(), names_of(columns_)));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const TableColumn& column = columns_[i];
    const auto place_of = static_cast<std::size_t>(plain ? i : std::ranges::find(names, column.name) - names.begin());
    const auto found = header.fields.begin() + static_cast<std::ptrdiff_t>(std::min(place_of, header.fields.size()));
    auto& place = places_.emplace_back();
    if (found != header.fields.end())
      place.emplace(Place{found->offset, found->type, found->swapped});
    else if (!column.absent)
      throw FileError(path_,
                      fmt::format("has no column {}{}; known are {}", column.name, column.remedy, names_of(columns_)));
  }
  open_rows(file.rest().value_or(0), 0, "rows");
}

/// `rest`: bytes behind the header, of which `before` come before the first row.
void TableFile::open_rows(std::uint64_t rest, std::uint64_t before, std::string_view rows) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw FileError(path_, std::string("cannot be opened: ") + std::strerror(errno));
  const auto size = static_cast<std::uint64_t>(::lseek(descriptor_, 0, SEEK_END));
  begin_ = size - rest + before;
  if (begin_ > size || (row_size_ > 0 && rows_ > (size - begin_) / row_size_))
    throw FileError(path_, fmt::format("ends early: the header says {} {}", rows_, rows));
}

TableFile::~TableFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

TableFile::TableFile(TableFile&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(std::move(other.columns_)),
      places_(std::move(other.places_)),
      rows_(other.rows_),
      begin_(other.begin_),
      row_size_(other.row_size_),
      row_name_(other.row_name_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

void TableFile::read(std::uint64_t first, std::uint64_t last, const TableSink& sink,
                     const std::stop_token& stop) const {
  constexpr std::uint64_t rows_at_once = 4096;
  TableRow row(path_, columns_);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (!places_[i]) row.set_absent(i);
  std::vector<char> bytes;
  while (first < last) {
    if (stop.stop_requested()) throw Stopped("stopped while reading " + shown_path(path_));
    const std::uint64_t count = std::min(rows_at_once, last - first);
    bytes.resize(count * row_size_);
    for (std::size_t done = 0; done < bytes.size();) {
      const auto offset = static_cast<off_t>(begin_ + first * row_size_ + done);
      const ssize_t got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done, offset);
      if (got == 0) throw FileError(path_, "ends early: it has become shorter");
      if (got < 0 && errno != EINTR) throw FileError(path_, std::string("cannot be read: ") + std::strerror(errno));
      if (got > 0) done += static_cast<std::size_t>(got);
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      for (std::size_t column = 0; column < places_.size(); ++column)
        if (const auto& place = places_[column])
          row.set(column, number_at(bytes.data() + i * row_size_ + place->offset, place->type, place->swapped));
      row.place(first + i + 1, rows_, row_name_);
      sink(row);
    }
    first += count;
  }
}

}  // namespace detp::sim
