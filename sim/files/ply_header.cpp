#include "ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "file_error.hpp"
#include "number_text.hpp"
#include "text_lines.hpp"

namespace detp::sim {
namespace {

struct TypeNames {
  std::string_view old_name;
  std::string_view sized_name;
};

/// In the order of NumberType, which has more.
constexpr std::array<TypeNames, 8> types{{{"char", "int8"},
                                          {"uchar", "uint8"},
                                          {"short", "int16"},
                                          {"ushort", "uint16"},
                                          {"int", "int32"},
                                          {"uint", "uint32"},
                                          {"float", "float32"},
                                          {"double", "float64"}}};

constexpr std::size_t most_bytes = 1 << 18;

class HeaderReader {
 public:
  explicit HeaderReader(InputFile& file) : file_(file), lines_(file) {}

  PlyHeader read() {
    if (!file_.fetch(1)) throw FileError(file_.path(), "is empty");
    next_line();
    if (line_ != "ply") fail("is not a PLY file; its first line must be \"ply\"");
    if (lines_.ended_by_cr_alone()) fail("the lines end in CR alone; a PLY file needs LF or CR LF");
    for (next_line(); line_ != "end_header"; next_line()) read_line();
    if (!has_format_) fail("the header has no format line");
    header_.lines = lines_.number();
    lines_.finish_line();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

  void next_line() {
    if (!lines_.next()) fail("the header ends early, without a line \"end_header\"");
    line_ = trimmed(lines_.line());
    bytes_ += lines_.line().size() + 1;
    if (bytes_ > most_bytes) fail("the header is longer than " + std::to_string(most_bytes) + " bytes");
  }

  void read_line() {
    std::string_view words = line_;
    const std::string_view keyword = cut_word(words);
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format")
      read_format(words);
    else if (keyword == "element")
      read_element(words);
    else if (keyword == "property")
      read_property(words);
    else
      fail("is not a line of a PLY header; expected format, comment, obj_info, element, property or end_header");
    if (!trimmed(words).empty()) fail("has too many words");
  }

  void read_format(std::string_view& words) {
    constexpr std::array<std::pair<std::string_view, PlyFormat>, 3> formats{
        {{"ascii", PlyFormat::ascii},
         {"binary_little_endian", PlyFormat::little_endian},
         {"binary_big_endian", PlyFormat::big_endian}}};
    const std::string_view name = cut_word(words);
    const auto found =
        std::find_if(formats.begin(), formats.end(), [name](auto& known) { return known.first == name; });
    if (found == formats.end() || cut_word(words) != "1.0")
      fail("unknown format; known are ascii, binary_little_endian and binary_big_endian, each 1.0");
    if (has_format_) fail("a second format line");
    header_.format = found->second;
    has_format_ = true;
  }

  void read_element(std::string_view& words) {
    const std::string name(cut_word(words));
    const std::string_view count = cut_word(words);
    std::uint64_t rows = 0;
    const auto [stop, error] = std::from_chars(count.data(), count.data() + count.size(), rows);
    if (count.empty() || stop != count.data() + count.size() || error != std::errc{})
      fail("expected \"element NAME COUNT\" with a whole number COUNT >= 0");
    for (const PlyElement& element : header_.elements)
      if (element.name == name) fail("a second element " + detp::quoted(name));
    header_.elements.push_back({.name = name, .rows = rows, .properties = {}});
  }

  void read_property(std::string_view& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    PlyProperty property;
    std::string_view type = cut_word(words);
    if (type == "list") {
      property.count_type = type_named(cut_word(words));
      if (*property.count_type >= NumberType::float32) fail("the length of a list needs a type of whole numbers");
      type = cut_word(words);
    }
    property.type = type_named(type);
    property.name = cut_word(words);
    if (property.name.empty()) fail("a property without a name");
    for (const PlyProperty& other : header_.elements.back().properties)
      if (other.name == property.name)
        fail("a second property " + detp::quoted(property.name) + " of the same element");
    header_.elements.back().properties.push_back(std::move(property));
  }

  [[nodiscard]] NumberType type_named(std::string_view name) const {
    for (std::size_t i = 0; i < types.size(); ++i)
      if (name == types[i].old_name || name == types[i].sized_name) return static_cast<NumberType>(i);
    fail(detp::quoted(name) + " is not a type; known types are char, uchar, short, ushort, int, uint, float, double");
  }

  InputFile& file_;
  TextLines lines_;
  std::string_view line_;
  std::size_t bytes_ = 0;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::optional<std::size_t> PlyElement::property(std::string_view wanted, bool list) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == wanted && properties[i].count_type.has_value() == list) return i;
  return std::nullopt;
}

std::vector<std::string> PlyElement::names() const {
  std::vector<std::string> all;
  for (const PlyProperty& property : properties) all.push_back(property.name);
  return all;
}

std::optional<std::size_t> PlyElement::number(std::string_view wanted, const std::vector<std::string>& names) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (names[i] == wanted && !properties[i].count_type) return i;
  return std::nullopt;
}

const PlyElement& element_of_rows(const std::string& path, const std::vector<PlyElement>& elements) {
  for (const char* name : {"vertex", "photon"})
    if (const auto found = std::ranges::find(elements, name, &PlyElement::name); found != elements.end()) return *found;
  if (elements.size() == 1) return elements.front();
  throw FileError(path, "has no element vertex or photon");
}

PlyHeader read_ply_header(InputFile& file) { return HeaderReader(file).read(); }

}  // namespace detp::sim
