#include "npy_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <optional>

#include "detp/model/vocabulary/quoted.hpp"
#include "file_error.hpp"

namespace detp::sim {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t longest_header = std::size_t{1} << 20;
constexpr std::size_t alignment = 64;  ///< of the first row in the file

/// Reads the literal of a Python dictionary that describes the array.
class Description {
 public:
  Description(std::string_view text, const std::string& path, bool vectors)
      : text_(text), path_(path), vectors_(vectors) {}

  NpyHeader read() {
    expect('{');
    while (!take('}')) {
      const std::string key = word();
      expect(':');
      if (key == "descr")
        read_type();
      else if (key == "fortran_order")
        fortran_ = read_flag();
      else if (key == "shape")
        shape_ = read_shape();
      else
        fail(fmt::format("has an unknown key {}", detp::quoted(key)));
      if (!take(',')) {
        expect('}');
        break;
      }
    }
    return header();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, fmt::format("is no array that can be read: its header {}", what));
  }

  void skip_blanks() { text_.remove_prefix(std::min(text_.find_first_not_of(" \t\n"), text_.size())); }
  bool take(char one) {
    skip_blanks();
    if (!text_.starts_with(one)) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char one) {
    if (!take(one)) fail(fmt::format("has no '{}' before {}", one, detp::quoted(text_.substr(0, 20))));
  }

  std::string word() {
    const char quote = take('"') ? '"' : '\'';
    if (quote == '\'') expect('\'');
    const std::size_t end = text_.find(quote);
    if (end == std::string_view::npos) fail("has a name that does not end");
    const std::string found(text_.substr(0, end));
    text_.remove_prefix(end + 1);
    return found;
  }

  bool read_flag() {
    skip_blanks();
    const bool flag = text_.starts_with("True");
    if (!flag && !text_.starts_with("False")) fail("says neither True nor False of fortran_order");
    text_.remove_prefix(flag ? 4 : 5);
    return flag;
  }

  std::vector<std::uint64_t> read_shape() {
    std::vector<std::uint64_t> shape;
    expect('(');
    while (!take(')')) {
      skip_blanks();
      std::uint64_t size = 0;
      const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), size);
      if (error != std::errc{}) fail("has a shape that is no list of whole numbers");
      text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
      shape.push_back(size);
      if (!take(',')) {
        expect(')');
        break;
      }
    }
    return shape;
  }

  /// One type, or a list of names with types.
  void read_type() {
    if (!take('[')) {
      add_field("", word());
      return;
    }
    structured_ = true;
    while (!take(']')) {
      expect('(');
      const std::string name = word();
      expect(',');
      skip_blanks();
      if (text_.starts_with('[')) fail(fmt::format("has fields in the field {}", detp::quoted(name)));
      add_field(name, word());
      if (take(',') && !take(')')) fail(fmt::format("has an array in the field {}", detp::quoted(name)));
      static_cast<void>(take(')'));
      if (!take(',')) {
        expect(']');
        break;
      }
    }
  }

  /// "<f8": order, kind and size. "|V4" is room without a meaning.
  void add_field(const std::string& name, const std::string& type) {
    const bool has_order = !type.empty() && std::string_view("<>=|").find(type.front()) != std::string_view::npos;
    const std::string_view kind_and_size = std::string_view(type).substr(has_order ? 1 : 0);
    if (kind_and_size.starts_with('V') && structured_) {
      std::size_t room = 0;
      std::from_chars(kind_and_size.data() + 1, kind_and_size.data() + kind_and_size.size(), room);
      row_size_ += room;
      return;
    }
    const auto found = number_type(kind_and_size);
    if (!found)
      fail(fmt::format("has numbers of the type {}; integers and floats of 4 or 8 bytes can be read",
                       detp::quoted(type)));
    const bool little = !has_order || type.front() != '>';
    fields_.push_back({name, *found, row_size_, little != (std::endian::native == std::endian::little)});
    row_size_ += size_of(*found);
  }

  static std::optional<NumberType> number_type(std::string_view text) {
    using enum NumberType;
    constexpr std::array<std::pair<std::string_view, NumberType>, 10> types{{{"i1", int8},
                                                                             {"u1", uint8},
                                                                             {"i2", int16},
                                                                             {"u2", uint16},
                                                                             {"i4", int32},
                                                                             {"u4", uint32},
                                                                             {"f4", float32},
                                                                             {"f8", float64},
                                                                             {"i8", int64},
                                                                             {"u8", uint64}}};
    const auto found = std::ranges::find(types, text, &std::pair<std::string_view, NumberType>::first);
    return found == types.end() ? std::nullopt : std::optional(found->second);
  }

  NpyHeader header() {
    if (fields_.empty()) fail("names no type of numbers");
    if (!shape_) fail("has no shape");
    if (vectors_ && !structured_ && shape_->size() == 1) shape_->push_back(1);
    if (shape_->size() != (structured_ ? 1U : 2U))
      fail(structured_
               ? fmt::format("has a structured array of {} dimensions; one is needed", shape_->size())
               : fmt::format("has an array of {} dimensions; two are needed: rows and columns", shape_->size()));
    if (fortran_ && !structured_) fail("says Fortran order; numpy.ascontiguousarray(array) has the order of C");
    if (structured_) return {(*shape_)[0], row_size_, fields_};
    NpyHeader plain{.rows = (*shape_)[0], .row_size = 0, .fields = {}};
    constexpr std::uint64_t most_columns = 1024;
    if ((*shape_)[1] > most_columns) fail(fmt::format("has an array of {} columns", (*shape_)[1]));
    for (std::uint64_t i = 0; i < (*shape_)[1]; ++i) {
      plain.fields.push_back(fields_.front());
      plain.fields.back().offset = plain.row_size;
      plain.row_size += size_of(fields_.front().type);
    }
    return plain;
  }

  std::string_view text_;
  const std::string& path_;
  bool vectors_;  ///< an array of one dimension is a column
  std::vector<NpyField> fields_;
  std::size_t row_size_ = 0;
  bool structured_ = false;
  bool fortran_ = false;
  std::optional<std::vector<std::uint64_t>> shape_;
};

}  // namespace

namespace {

/// The size of the header from the front of a file; 0 if that is too short to say. Throws FileError if there is none.
std::size_t header_size(std::string_view front, const std::string& path) {
  constexpr std::size_t before_length = 8;
  if (front.size() < before_length + 2 || !front.starts_with(magic))
    throw FileError(path, "is no NumPy file: it does not begin with \\x93NUMPY");
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(front[at]); };
  const std::size_t of_length = byte(magic.size()) == 1 ? 2 : 4;
  if (front.size() < before_length + of_length) return 0;
  std::size_t length = 0;
  for (std::size_t i = of_length; i > 0; --i) length = 256 * length + byte(before_length + i - 1);
  if (length > longest_header) throw FileError(path, fmt::format("has a header of {} bytes", length));
  return before_length + of_length + length;
}

NpyHeader header_in(std::string_view bytes, const std::string& path, bool vectors) {
  const std::size_t before = 8 + (static_cast<unsigned char>(bytes[magic.size()]) == 1 ? 2 : 4);
  return Description(bytes.substr(before), path, vectors).read();
}

}  // namespace

NpyHeader read_npy_header(InputFile& file) {
  constexpr std::size_t longest_before = 12;
  static_cast<void>(file.fetch(longest_before));
  const std::size_t size = header_size(file.buffered(), file.path());
  if (size == 0 || !file.fetch(size)) throw FileError(file.path(), "ends in its header");
  NpyHeader header = header_in(file.buffered().substr(0, size), file.path(), false);
  file.skip(size);
  return header;
}

NpyHeader npy_header_in(std::string_view bytes, const std::string& path, std::size_t& begin) {
  begin = header_size(bytes, path);
  if (begin == 0 || begin > bytes.size()) throw FileError(path, "ends in its header");
  return header_in(bytes.substr(0, begin), path, true);
}

std::string npy_header(const std::vector<NpyColumn>& columns, std::uint64_t rows) {
  std::string fields;
  for (const auto& [name, type] : columns) fields += fmt::format("('{}', '{}'), ", name, type);
  std::string text = fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", fields, rows);
  constexpr std::size_t before = 12;
  while ((before + text.size() + 1) % alignment != 0) text += ' ';
  text += '\n';
  std::string header(magic);
  header += std::string_view("\x02\x00", 2);
  for (std::size_t i = 0, length = text.size(); i < 4; ++i, length /= 256) header += static_cast<char>(length % 256);
  return header + text;
}

}  // namespace detp::sim
