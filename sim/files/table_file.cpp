#include "table_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "file_error.hpp"
#include "input_file.hpp"
#include "ply_number.hpp"

namespace detp::sim {
namespace {

std::size_t size_of_row(const PlyElement& element) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties) size += size_of(property.type);
  return size;
}

bool has_list(const PlyElement& element) {
  return std::ranges::any_of(element.properties, [](const PlyProperty& one) { return one.count_type.has_value(); });
}

}  // namespace

std::optional<TableFile> TableFile::open(const std::string& path, const std::vector<TableColumn>& columns) {
  std::error_code unknown;
  if (!has_ending(path, ".ply") || !std::filesystem::is_regular_file(path, unknown))
    return std::nullopt;  // a pipe is read once
  InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  if (header.format == PlyFormat::ascii || !file.rest()) return std::nullopt;
  TableFile table(path, columns);
  table.swapped_ = (header.format == PlyFormat::little_endian) != (std::endian::native == std::endian::little);
  std::uint64_t before = 0;  // bytes of the elements before the vertices
  const auto vertex = std::ranges::find(header.elements, "vertex", &PlyElement::name);
  if (vertex == header.elements.end()) throw FileError(path, "has no element vertex");
  for (auto element = header.elements.begin(); element <= vertex; ++element) {
    if (has_list(*element)) return std::nullopt;
    if (element != vertex) before += element->rows * size_of_row(*element);
  }
  table.rows_ = vertex->rows;
  table.row_size_ = size_of_row(*vertex);
  for (const TableColumn& column : columns) {
    auto& place = table.places_.emplace_back();
    if (const auto property = vertex->property(column.name, false)) {
      place.emplace();
      place->type = vertex->properties[*property].type;
      for (std::size_t i = 0; i < *property; ++i) place->offset += size_of(vertex->properties[i].type);
    } else if (!column.absent) {
      throw FileError(path, fmt::format("its element vertex has no property {}{}", column.name, column.remedy));
    }
  }
  table.descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (table.descriptor_ < 0) throw FileError(path, std::string("cannot be opened: ") + std::strerror(errno));
  const auto size = static_cast<std::uint64_t>(::lseek(table.descriptor_, 0, SEEK_END));
  table.begin_ = size - *file.rest() + before;
  if (table.begin_ > size || table.rows_ > (size - table.begin_) / table.row_size_)
    throw FileError(path, fmt::format("ends early: the header says {} rows of element vertex", table.rows_));
  return table;
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
      swapped_(other.swapped_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

void TableFile::read(std::uint64_t first, std::uint64_t last, const TableSink& sink) const {
  constexpr std::uint64_t rows_at_once = 4096;
  TableRow row(path_, columns_);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (!places_[i]) row.set_absent(i);
  std::vector<char> bytes;
  while (first < last) {
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
          row.set(column, ply_number(bytes.data() + i * row_size_ + place->offset, place->type, swapped_));
      row.place(first + i + 1, rows_);
      sink(row);
    }
    first += count;
  }
}

}  // namespace detp::sim
