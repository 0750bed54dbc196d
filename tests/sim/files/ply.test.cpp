#include "detp/sim/files/ply.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <stop_token>
#include <utility>

#include "detp/sim/files/mesh_file.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::ScratchFolder;

namespace {

struct Thing {
  std::array<std::vector<double>, 9> columns;  ///< by property, then by row; for the list the entries of all rows
  std::vector<std::size_t> ends;               ///< ends of the list's rows
};

/// The element "thing" with all its properties.
Thing read_thing(const std::string& path, std::stop_token stop = {}) {
  PlyFile file(path, std::move(stop));
  Thing thing;
  PlyRequest request{.element = "thing", .properties = {}, .on_row = {}};
  if (const PlyElement* element = file.element("thing"))
    for (std::size_t i = 0; i < element->properties.size() && i < 9; ++i) request.properties.push_back(i);
  request.on_row = [&](std::uint64_t, const PlyValues& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      thing.columns[i].insert(thing.columns[i].end(), values[i].begin(), values[i].end());
    thing.ends.push_back(thing.columns[8].size());
  };
  file.read({request});
  return thing;
}

constexpr const char* all_types = R"(comment every type under one of its two names
obj_info as some scanners write it
element other 2
property uchar skipped
property list ushort double skipped_list
element thing 2
property char a
property uint8 b
property short c
property uint16 d
property int e
property uint32 f
property float g
property float64 h
property list uchar short few
element last 1
property float x
end_header
)";

std::string header(const std::string& format) { return "ply\nformat " + format + " 1.0\n" + all_types; }

/// Writes numbers as the bytes of a binary file.
class Bytes {
 public:
  explicit Bytes(std::endian order) : order_(order) {}

  template <class Number>
  Bytes& add(Number number) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    text_.append(bytes.data(), bytes.size());
    return *this;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::endian order_;
  std::string text_;
};

std::string binary_body(std::endian order) {
  Bytes bytes(order);
  bytes.add(std::uint8_t{9}).add(std::uint16_t{2}).add(1.0).add(2.0);
  bytes.add(std::uint8_t{9}).add(std::uint16_t{0});
  bytes.add(std::int8_t{-128}).add(std::uint8_t{255}).add(std::int16_t{-32768}).add(std::uint16_t{65535});
  bytes.add(std::int32_t{-2147483647}).add(std::uint32_t{4294967295}).add(0.5F).add(0.1);
  bytes.add(std::uint8_t{2}).add(std::int16_t{-7}).add(std::int16_t{8});
  bytes.add(std::int8_t{1}).add(std::uint8_t{2}).add(std::int16_t{3}).add(std::uint16_t{4});
  bytes.add(std::int32_t{5}).add(std::uint32_t{6}).add(7.0F).add(8.0).add(std::uint8_t{0});
  bytes.add(1.0F);
  return bytes.text();
}

constexpr const char* ascii_body =
    "9 2 1 2\n9 0\n\n"
    "-128 255 -32768 65535 -2147483647 4294967295 +0.5 0.1 2 -7 8\n"
    "1 2 3 4 5 6 7 8 0\n"
    "1\n";

void check_values(const std::string& content) {
  const ScratchFolder folder;
  const std::string path = folder.file("t.ply", content);
  const PlyFile file(path);
  REQUIRE(file.element("thing") != nullptr);
  CHECK(file.element("thing")->rows == 2);
  CHECK(file.element("thing")->property("c", false) == 2);
  CHECK(file.element("thing")->property("few", true) == 8);
  CHECK(!file.element("thing")->property("few", false));
  CHECK(file.element("nothing") == nullptr);
  const Thing thing = read_thing(path);
  const std::array<std::vector<double>, 9> expected{
      {{-128, 1}, {255, 2}, {-32768, 3}, {65535, 4}, {-2147483647, 5}, {4294967295, 6}, {0.5, 7}, {0.1, 8}, {-7, 8}}};
  CHECK(thing.columns == expected);
  CHECK(thing.ends == std::vector<std::size_t>{2, 2});
}

std::string ply_error(const std::string& content) {
  const ScratchFolder folder;
  return support::file_error_of([&] { (void)read_thing(folder.file("t.ply", content)); });
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("all types, lists and skipped elements are read equally from ascii and both binary formats") {
    check_values(header("ascii") + ascii_body);
    check_values(header("binary_little_endian") + binary_body(std::endian::little));
    check_values(header("binary_big_endian") + binary_body(std::endian::big));
  }

  TEST_CASE("a leading byte order mark is accepted") { check_values("\xEF\xBB\xBF" + header("ascii") + ascii_body); }

  TEST_CASE("CR LF line ends are accepted") {
    std::string text;
    for (const char c : header("ascii") + ascii_body) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    check_values(text);
    std::string binary;
    for (const char c : header("binary_big_endian")) binary += c == '\n' ? std::string("\r\n") : std::string(1, c);
    check_values(binary + binary_body(std::endian::big));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a malformed header is refused with its line") {
    const std::string start = "ply\nformat ascii 1.0\n";
    for (const auto& [bound_content, reason] :
         {std::pair<std::string, const char*>{"", ": is empty"},
          {"plyx\n", ":1: is not a PLY file"},
          {"ply\nformat ascii 2.0\n", ":2: unknown format"},
          {"ply\nformat binary 1.0\n", ":2: unknown format"},
          {"ply\nend_header\n", ":2: the header has no format line"},
          {start, ":2: the header ends early"},
          {start + "element thing -1\n", ":3: expected"},
          {start + "element thing 99999999999999999999\n", ":3: expected"},
          {start + "element thing 1 2\n", ":3: has too many words"},
          {start + "property float a\n", ":3: a property before"},
          {start + "element thing 1\nproperty real a\n", ":4: \"real\" is not a type"},
          {start + "element thing 1\nproperty float\n", ":4: a property without a name"},
          {start + "element thing 1\nproperty list float int a\n", ":4: the length of a list"},
          {start + "element thing 1\nproperty float a\nproperty int a\n", ":5: a second property \"a\""},
          {start + "element thing 1\nelement thing 1\n", ":4: a second element"},
          {start + "elements\n", ":3: is not a line of a PLY header"},
          {start + "element thing 1\nproperty \x1b]0;title\x07 a\n", ":4: \"\\x1b]0;title\\x07\" is not a type"},
          {start + "element thing 1\nproperty " + std::string(100'000, 'y') + " a\n", "yyy...\" is not a type"},
          {"ply\rformat ascii 1.0\rend_header\r", ":1: the lines end in CR alone"},
          {std::string(5000, '\0'), ":1: contains a NUL byte"},
          {std::string("\xFE\xFF\0p\0l\0y", 8), ": is text in UTF-16"},
          {start + std::string(400'000, 'c'), ":3: the header is longer than 262144 bytes"}}) {
      const auto& content = bound_content;
      CAPTURE(content.substr(0, 200));
      const std::string message = ply_error(content);
      CHECK_MESSAGE(message.find(reason) != std::string::npos, message);
      CHECK(message.find('\x1b') == std::string::npos);
    }
  }

  TEST_CASE("a malformed body is refused with the element and the row") {
    const std::string start = "ply\nformat ascii 1.0\nelement thing 2\nproperty float a\nend_header\n";
    const std::string list = "ply\nformat ascii 1.0\nelement thing 2\nproperty list int int few\nend_header\n";
    support::check_errors({{start + "1\nx\n", "thing 2 of 2 (line 7): its \"a\" is not a number"},
                           {start + "  1\n ", "thing 2 of 2 (line 7): the file ends early"},
                           {start + "1\n2\n3\n", "has more data than its header declares (line 8)"},
                           {list + "1 7\n-1\n", "thing 2 of 2 (line 7): its \"few\" has no valid length"},
                           {list + "1 7\n1.5 8 9\n", "thing 2 of 2 (line 7): its \"few\" has no valid length"},
                           {list + "1 7\nnan 8\n", "thing 2 of 2 (line 7): its \"few\" has no valid length"},
                           {list + "1 7\n1e9 8\n", "thing 2 of 2 (line 7): the file ends early"}},
                          [&](const std::string& content) { return ply_error(content); });
    const std::string whole = binary_body(std::endian::little);
    CHECK(ply_error(header("binary_little_endian") + whole.substr(0, whole.size() - 12))
              .find("2 rows of element thing") != std::string::npos);
    const std::string few = "ply\nformat binary_big_endian 1.0\nelement thing 1\nproperty list uchar double few\n";
    CHECK(ply_error(few + "end_header\n\x02" + std::string(15, 'x')).find("thing 1 of 1: the file ends early") !=
          std::string::npos);
    CHECK(
        ply_error(few + "property double a\nend_header\n\x01" + std::string(15, 'x')).find("thing 1 of 1: the file") !=
        std::string::npos);
  }

  TEST_CASE("a header that declares more than the file can hold allocates no memory") {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
      for (const char* property : {"property float a", "property list uint double few", ""}) {
        CAPTURE(format);
        const std::string element = std::string("\nelement thing 1000000000000000000\n") + property;
        const std::string content = std::string("ply\nformat ") + format + " 1.0" + element + "\nend_header\n12";
        const std::string message = ply_error(content);
        CHECK((message.find("ends early") != std::string::npos || *property == '\0'));
      }
  }

  TEST_CASE("a damaged file is read or refused, with no other effect") {
    const auto read = [](const std::string& path) { (void)read_thing(path); };
    CHECK(support::refused_when_damaged("t.ply", header("ascii") + ascii_body, 1500, read) > 200);
    CHECK(support::refused_when_damaged("t.ply", header("binary_little_endian") + binary_body(std::endian::little),
                                        1500, read) > 200);
    CHECK(support::refused_when_damaged("t.ply", header("binary_big_endian") + binary_body(std::endian::big), 1500,
                                        read) > 200);
  }

  TEST_CASE("a damaged binary mesh is read or refused, with no other effect") {
    const support::ScratchFolder folder;
    write_ply(folder.path("mesh.ply"),
              {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}}});
    const std::string content = support::content_of(folder.path("mesh.ply"));
    const std::size_t refused = support::refused_when_damaged("m.ply", content, 2500, [](const std::string& path) {
      Notices notices;
      (void)read_mesh(path, notices);
    });
    CHECK(refused > content.size());
  }
}

TEST_SUITE("identity") {
  TEST_CASE("a written mesh is read back bit for bit, with and without normals") {
    Mesh mesh{.positions = {{0.1, -1e-300, 1e300}, {1.0 / 3, 0, 0}, {0, 1, 0}, {7, 7, 7}},
              .normals = {},
              .triangles = {{0, 1, 2}, {3, 2, 0}, {1, 1, 1}}};
    const support::ScratchFolder folder;
    for (const bool with_normals : {false, true}) {
      if (with_normals) mesh.normals = {{0, 0, 1}, {0, 0.1, 0}, {1e-200, 0, 0}, {1, 2, 3}};
      write_ply(folder.path("mesh.ply"), mesh);
      Notices notices;
      const Mesh back = read_mesh(folder.path("mesh.ply"), notices);
      CHECK(back.positions == mesh.positions);
      CHECK(back.normals == mesh.normals);
      CHECK(back.triangles == mesh.triangles);
      REQUIRE(notices.size() == 1);
      CHECK(notices[0] == "faces without area, or that cross themselves: 1");
    }
  }
}
