#include "ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "file_error.hpp"
#include "input_file.hpp"
#include "number_text.hpp"
#include "ply_header.hpp"

namespace detp::sim {
namespace {

/// Numbers written as text, between any blanks and line ends.
class TextSource {
 public:
  TextSource(std::string_view body, std::size_t lines_before) : rest_(body), line_(lines_before + 1) {}

  /// The fewest bytes that a number takes: a digit and a separator.
  static std::uint64_t least_size(PlyType) { return 2; }

  /// The last number needs no separator.
  [[nodiscard]] std::uint64_t size() const { return rest_.size() + 1; }

  /// The next number; nothing at the end of the file or before what is no number.
  std::optional<double> next(PlyType) {
    skip_space();
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    const auto number = number_in(word);
    if (number) rest_.remove_prefix(word.size());
    return number;
  }

  /// Why there was no next number.
  [[nodiscard]] std::string why_none(const std::string& name) const {
    return rest_.empty() ? "the file ends early" : "its \"" + name + "\" is not a number";
  }

  [[nodiscard]] bool at_end() {
    skip_space();
    return rest_.empty();
  }

  [[nodiscard]] std::string where() const { return " (line " + std::to_string(line_) + ")"; }

 private:
  void skip_space() {
    const std::size_t skipped = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
    line_ +=
        static_cast<std::size_t>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(skipped), '\n'));
    rest_.remove_prefix(skipped);
  }

  std::string_view rest_;
  std::size_t line_;
};

/// Numbers as bytes.
class BinarySource {
 public:
  BinarySource(std::string_view body, std::endian order) : rest_(body), swapped_(order != std::endian::native) {}

  static std::uint64_t least_size(PlyType type) { return size_of(type); }
  [[nodiscard]] std::uint64_t size() const { return rest_.size(); }

  std::optional<double> next(PlyType type) {
    if (rest_.size() < size_of(type)) return std::nullopt;
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>();
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return take<std::int16_t>();
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return take<std::int32_t>();
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::float32:
        return take<float>();
      case PlyType::float64:
        return take<double>();
    }
    return std::nullopt;
  }

  [[nodiscard]] static std::string why_none(const std::string&) { return "the file ends early"; }

  /// What follows the last element is no concern of a binary file: many writers end it with a line feed.
  [[nodiscard]] static bool at_end() { return true; }
  [[nodiscard]] static std::string where() { return {}; }

 private:
  template <class Number>
  double take() {
    std::array<char, sizeof(Number)> bytes;
    std::copy_n(rest_.begin(), sizeof(Number), bytes.begin());
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    rest_.remove_prefix(sizeof(Number));
    return static_cast<double>(std::bit_cast<Number>(bytes));
  }

  std::string_view rest_;
  bool swapped_;
};

template <class Source>
class BodyReader {
 public:
  BodyReader(const std::string& path, Source source) : path_(path), source_(std::move(source)) {}

  PlyRows read(const PlyElement& element, const std::vector<std::string>& wanted) {
    check_size(element);
    PlyRows rows;
    rows.rows = element.rows;
    std::vector<PlyColumn*> columns;  // where each property goes, null: nowhere
    for (const PlyProperty& property : element.properties) {
      const bool keep = std::find(wanted.begin(), wanted.end(), property.name) != wanted.end();
      columns.push_back(keep ? &rows.columns[property.name] : nullptr);
      if (keep) prepare(*columns.back(), property, element.rows);
    }
    if (element.properties.empty()) return rows;
    for (row_ = 1; row_ <= element.rows; ++row_)
      for (std::size_t i = 0; i < columns.size(); ++i) read(element, element.properties[i], columns[i]);
    return rows;
  }

  void check_end() {
    if (!source_.at_end()) throw FileError(path_, "holds more than its header says" + source_.where());
  }

 private:
  [[noreturn]] void fail(const PlyElement& element, const std::string& what) const {
    throw FileError(path_, element.name + " " + std::to_string(row_) + " of " + std::to_string(element.rows) +
                               source_.where() + ": " + what);
  }

  /// Before memory is taken.
  void check_size(const PlyElement& element) const {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties)
      least += Source::least_size(property.count_type.value_or(property.type));
    if (least > 0 && element.rows > source_.size() / least)
      throw FileError(path_, "ends early: the header says " + std::to_string(element.rows) + " rows of element " +
                                 element.name + ", the file has room for " + std::to_string(source_.size() / least));
  }

  static void prepare(PlyColumn& column, const PlyProperty& property, std::uint64_t rows) {
    column.is_list = property.count_type.has_value();
    if (column.is_list)
      column.ends.reserve(rows);
    else
      column.values.reserve(rows);
  }

  void read(const PlyElement& element, const PlyProperty& property, PlyColumn* column) {
    double entries = 1;
    if (property.count_type) entries = length(element, property, number(element, property.name, *property.count_type));
    for (; entries > 0; --entries) {
      const double value = number(element, property.name, property.type);
      if (column != nullptr) column->values.push_back(value);
    }
    if (column != nullptr && column->is_list) column->ends.push_back(column->values.size());
  }

  double number(const PlyElement& element, const std::string& name, PlyType type) {
    const auto value = source_.next(type);
    if (!value) fail(element, source_.why_none(name));
    return *value;
  }

  double length(const PlyElement& element, const PlyProperty& property, double count) const {
    if (!(count >= 0) || std::floor(count) != count) fail(element, "its \"" + property.name + "\" has no valid length");
    if (count * static_cast<double>(Source::least_size(property.type)) > static_cast<double>(source_.size()))
      fail(element, "the file ends early, within \"" + property.name + "\"");
    return count;
  }

  const std::string& path_;
  Source source_;
  std::uint64_t row_ = 1;
};

template <class Source>
std::map<std::string, PlyRows, std::less<>> read_body(const std::string& path, const PlyHeader& header,
                                                      const PlyWish& wish, Source source) {
  std::map<std::string, PlyRows, std::less<>> wanted;
  BodyReader<Source> body(path, std::move(source));
  for (const PlyElement& element : header.elements) {
    const auto wished = wish.find(element.name);
    const std::vector<std::string> none;
    PlyRows rows = body.read(element, wished == wish.end() ? none : wished->second);
    if (wished != wish.end()) wanted.emplace(element.name, std::move(rows));
  }
  body.check_end();
  return wanted;
}

}  // namespace

const PlyColumn* PlyRows::column(std::string_view name, bool is_list) const {
  const auto found = columns.find(name);
  return found != columns.end() && found->second.is_list == is_list ? &found->second : nullptr;
}

std::map<std::string, PlyRows, std::less<>> read_ply(const std::string& path, const PlyWish& wish) {
  const std::string content = read_file(path);
  if (content.empty()) throw FileError(path, "is empty");
  const PlyHeader header = read_ply_header(path, content);
  const std::string_view body = std::string_view(content).substr(header.size);
  if (header.format == PlyFormat::ascii) return read_body(path, header, wish, TextSource(body, header.lines));
  const bool little = header.format == PlyFormat::little_endian;
  return read_body(path, header, wish, BinarySource(body, little ? std::endian::little : std::endian::big));
}

}  // namespace detp::sim
