#include "npz.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "npy_header.hpp"

namespace detp::sim {
namespace {

/// The files of a ZIP archive. (PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", 6.3.10: 4.3.7, 4.3.12, 4.3.16.)
class ZipArchive {
 public:
  ZipArchive(const std::string& path, std::string content) : path_(path), content_(std::move(content)) {
    constexpr std::size_t end_size = 22;
    const std::size_t end = content_.rfind(std::string_view("PK\x05\x06", 4));
    if (end == std::string::npos || content_.size() - end < end_size) fail("is no ZIP archive, as numpy.savez writes");
    entries_ = number(end + 10, 2);
    next_ = number(end + 16, 4);
  }

  struct Member {
    std::string name;
    std::string bytes;
  };

  /// The next file; none at the end.
  std::optional<Member> next() {
    if (given_++ == entries_) return std::nullopt;
    constexpr std::size_t entry_size = 46;
    require(next_, entry_size, "PK\x01\x02");
    const std::size_t method = number(next_ + 10, 2);
    const std::size_t packed = number(next_ + 20, 4);
    const std::size_t whole = number(next_ + 24, 4);
    const std::size_t name_length = number(next_ + 28, 2);
    const std::size_t begin = number(next_ + 42, 4);
    if (std::max({packed, whole, begin}) == 0xFFFFFFFF)
      fail("has arrays of more than 4 GiB, which are not read; .npy is");
    if (name_length > content_.size() - next_ - entry_size) fail("ends early");
    Member member{content_.substr(next_ + entry_size, name_length), {}};
    constexpr std::size_t local_size = 30;
    require(begin, local_size, "PK\x03\x04");
    const std::size_t data = begin + local_size + number(begin + 26, 2) + number(begin + 28, 2);
    if (data > content_.size() || packed > content_.size() - data) fail("ends early");
    const std::size_t checksum = number(next_ + 16, 4);
    next_ += entry_size + name_length + number(next_ + 30, 2) + number(next_ + 32, 2);
    member.bytes = unpacked(std::string_view(content_).substr(data, packed), method, whole);
    if (crc32_z(0, reinterpret_cast<const Bytef*>(member.bytes.data()), member.bytes.size()) != checksum)
      fail("is a damaged ZIP archive");
    return member;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_, what); }

  [[nodiscard]] std::size_t number(std::size_t at, std::size_t bytes) const {
    std::size_t found = 0;
    for (std::size_t i = bytes; i > 0; --i) found = 256 * found + static_cast<unsigned char>(content_.at(at + i - 1));
    return found;
  }

  void require(std::size_t at, std::size_t size, const char* mark) const {
    if (at > content_.size() || content_.size() - at < size || content_.compare(at, 4, mark) != 0)
      fail("is a damaged ZIP archive");
  }

  [[nodiscard]] std::string unpacked(std::string_view packed, std::size_t method, std::size_t whole) const {
    constexpr std::size_t stored = 0;
    constexpr std::size_t deflated = 8;
    if (method == stored) return std::string(packed);
    if (method != deflated) fail(fmt::format("is compressed by method {}; stored and deflated are read", method));
    constexpr std::size_t most_compression = 1100;  // of deflate, about
    if (whole / most_compression > packed.size()) fail("has damaged compressed data");
    require_memory("an array of " + shown_path(path_), static_cast<double>(whole));
    std::string bytes(whole, '\0');
    z_stream state{};
    if (inflateInit2(&state, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib does not write there
    state.avail_in = static_cast<uInt>(packed.size());
    state.next_out = reinterpret_cast<Bytef*>(bytes.data());
    state.avail_out = static_cast<uInt>(bytes.size());
    const int result = inflate(&state, Z_FINISH);
    const bool complete = result == Z_STREAM_END && state.avail_out == 0;
    inflateEnd(&state);
    if (!complete) fail("has damaged compressed data");
    return bytes;
  }

  const std::string& path_;
  std::string content_;
  std::size_t entries_ = 0;
  std::size_t next_ = 0;
  std::size_t given_ = 0;
};

struct Array {
  std::string name;
  std::string bytes;
  std::size_t begin = 0;
  NpyHeader header;
};

/// A column, and where it is.
struct ArrayColumn {
  std::string name;
  const Array* array;
  const NpyField* field;
};

std::vector<ArrayColumn> columns_of(const Array& array) {
  std::vector<ArrayColumn> columns;
  const std::vector<NpyField>& fields = array.header.fields;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string number = fields.size() == 3 ? std::string(1, "xyz"[i]) : fmt::format("_{}", i + 1);
    columns.push_back({!fields[i].name.empty() ? fields[i].name
                       : fields.size() == 1    ? array.name
                                               : array.name + number,
                       &array, &fields[i]});
  }
  return columns;
}

/// Nothing for arrays of other kinds than columns of numbers.
std::optional<Array> array_of(ZipArchive::Member member, const std::string& path) {
  Array array{.name = member.name.ends_with(".npy") ? member.name.substr(0, member.name.size() - 4) : member.name,
              .bytes = std::move(member.bytes),
              .begin = 0,
              .header = {}};
  try {
    array.header = npy_header_in(array.bytes, path, array.begin);
  } catch (const FileError&) {
    return std::nullopt;
  }
  if (array.header.row_size > 0 && array.header.rows > (array.bytes.size() - array.begin) / array.header.row_size)
    throw FileError(path, fmt::format("ends early: its array {} has not all of its rows", array.name));
  return array;
}

}  // namespace

std::size_t read_npz(const std::string& path, const ColumnChoice& choice, const TableSink& sink, std::stop_token stop) {
  ZipArchive archive(path, read_file(path, static_cast<std::size_t>(memory_budget()), stop));
  std::vector<Array> arrays;
  std::vector<std::string> names;
  std::vector<std::string> others;
  while (auto member = archive.next()) {
    std::string name = member->name;
    if (auto array = array_of(std::move(*member), path))
      arrays.push_back(std::move(*array));
    else
      others.push_back(std::move(name));
  }
  std::vector<ArrayColumn> found;
  for (const Array& array : arrays) {
    if (array.header.rows != arrays.front().header.rows)
      throw FileError(path,
                      fmt::format("has arrays of different lengths: {} has {} rows, {} has {}", arrays.front().name,
                                  arrays.front().header.rows, array.name, array.header.rows));
    for (const ArrayColumn& one : columns_of(array)) found.push_back(one);
  }
  for (const ArrayColumn& one : found) names.push_back(one.name);
  names.insert(names.end(), others.begin(), others.end());
  names = choice.known(path, std::move(names));
  const std::vector<TableColumn> columns = choice(path, names);
  choice.sort_out(path, names, columns);
  TableRow row(path, columns);
  std::vector<const ArrayColumn*> places;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto place = static_cast<std::size_t>(std::ranges::find(names, columns[i].name) - names.begin());
    places.push_back(place < found.size() ? &found[place] : nullptr);
    if (places.back() != nullptr) continue;
    if (!columns[i].absent) throw FileError(path, fmt::format("has no array {}{}", columns[i].name, columns[i].remedy));
    row.set_absent(i);
  }
  const std::size_t rows = arrays.empty() ? 0 : arrays.front().header.rows;
  StopCheck check(std::move(stop), "reading arrays");
  for (std::size_t i = 0; i < rows; ++i) {
    check.after(1);
    for (std::size_t column = 0; column < places.size(); ++column)
      if (const ArrayColumn* place = places[column]; place != nullptr)
        row.set(column, number_at(place->array->bytes.data() + place->array->begin + i * place->array->header.row_size +
                                      place->field->offset,
                                  place->field->type, place->field->swapped));
    row.place(i + 1, rows, "row");
    sink(row);
  }
  return rows;
}

}  // namespace detp::sim
