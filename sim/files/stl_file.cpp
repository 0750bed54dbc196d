#include "stl_file.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/kept_memory.hpp"
#include "file_error.hpp"
#include "input_file.hpp"
#include "number_bytes.hpp"
#include "number_text.hpp"
#include "text_lines.hpp"

namespace detp::sim {
namespace {

/// Each corner is a vertex; samples_at_vertices joins those at the same place.
class TriangleSoup {
 public:
  explicit TriangleSoup(const std::string& path) : path_(path), memory_(path) {}

  void add(const std::array<glm::dvec3, 3>& corners, std::size_t expected = 0) {
    const std::size_t first = mesh_.positions.size();
    if (first > UINT32_MAX - 3) throw FileError(path_, "has more than 1.4 billion triangles, which is too many");
    for (const glm::dvec3& corner : corners) memory_.push(mesh_.positions, corner, 3 * expected);
    const auto number = static_cast<std::uint32_t>(first);
    memory_.push(mesh_.triangles, {number, number + 1, number + 2}, expected);
  }
  [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }
  [[nodiscard]] Mesh finished() && { return std::move(mesh_); }

 private:
  std::string path_;
  KeptMemory memory_;
  Mesh mesh_;
};

constexpr std::size_t head_size = 84;   // 80 bytes of text, number of triangles
constexpr std::size_t facet_size = 50;  // normal, three corners, two bytes

std::uint32_t count_in(std::string_view head) {
  constexpr bool swapped = std::endian::native != std::endian::little;
  return static_cast<std::uint32_t>(number_at(head.data() + 80, NumberType::uint32, swapped));
}

/// Binary files may begin with "solid", too. What decides is the size, or else that text has no such bytes.
bool is_binary(InputFile& file) {
  if (!file.fetch(head_size)) return false;
  const std::string_view head = file.buffered();
  if (const auto size = file.rest(); size && *size == head_size + std::uint64_t{facet_size} * count_in(head))
    return true;
  return !head.starts_with("solid") || head.substr(0, head_size).find('\0') != std::string_view::npos;
}

Mesh read_binary(InputFile& file) {
  constexpr bool swapped = std::endian::native != std::endian::little;
  TriangleSoup soup(file.path());
  const std::uint32_t count = count_in(file.buffered());
  file.skip(head_size);
  if (const auto size = file.rest(); size && *size / facet_size < count)
    throw FileError(file.path(),
                    fmt::format("ends early: as binary STL its head says {} triangles; text begins with solid", count));
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!file.fetch(facet_size))
      throw FileError(file.path(),
                      fmt::format("ends early: as binary STL its head says {} triangles, it has {}", count, i));
    const char* const bytes = file.buffered().data();
    std::array<glm::dvec3, 3> corners;
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        corners[static_cast<std::size_t>(corner)][axis] =
            number_at(bytes + 12 * (corner + 1) + 4 * axis, NumberType::float32, swapped);
    file.skip(facet_size);
    soup.add(corners, count);
  }
  return std::move(soup).finished();
}

/// Words: solid NAME, facet normal x y z, outer loop, three times vertex x y z, endloop, endfacet, endsolid NAME.
class StlText {
 public:
  explicit StlText(InputFile& file) : lines_(file), soup_(file.path()) {}

  Mesh read() {
    while (lines_.next()) {
      std::string_view words = lines_.line();
      const std::string_view keyword = cut_word(words);
      if (keyword.empty()) continue;
      if (keyword == "solid")
        begin_solid(std::string(trimmed(words)));
      else if (keyword == "facet")
        corners_.clear();
      else if (keyword == "vertex")
        add_corner(words);
      else if (keyword == "endloop")
        end_loop();
      else if (keyword != "outer" && keyword != "endfacet" && keyword != "endsolid")
        lines_.fail(
            fmt::format("{} is no word of STL; expected solid, facet, outer loop, vertex, endloop, endfacet or "
                        "endsolid",
                        detp::quoted(keyword)));
    }
    if (!corners_.empty()) lines_.fail("ends within a facet");
    Mesh mesh = std::move(soup_).finished();
    if (of_triangle_.empty()) return mesh;
    of_triangle_.resize(mesh.triangles.size(), set_);
    mesh.groups = {std::move(names_), std::move(sets_), std::move(of_triangle_)};
    return mesh;
  }

 private:
  void begin_solid(std::string name) {
    if (name.empty() && names_.empty()) return;
    of_triangle_.resize(soup_.triangles(), set_);
    if (sets_.empty() && soup_.triangles() > 0) sets_.emplace_back();  // of triangles before the first name
    names_.push_back(std::move(name));
    sets_.push_back({static_cast<std::uint32_t>(names_.size() - 1)});
    set_ = static_cast<std::uint32_t>(sets_.size() - 1);
    named_ = true;
  }

  void add_corner(std::string_view words) {
    glm::dvec3 position{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = cut_word(words);
      const auto number = number_in(word);
      if (!number) lines_.fail(fmt::format("{} is not a number", detp::quoted(word)));
      position[axis] = *number;
    }
    corners_.push_back(position);
    if (corners_.size() > 3) lines_.fail("a facet has three corners");
  }

  void end_loop() {
    if (corners_.size() != 3) lines_.fail(fmt::format("a facet has three corners (got {})", corners_.size()));
    soup_.add({corners_[0], corners_[1], corners_[2]});
    if (named_) of_triangle_.resize(soup_.triangles(), set_);
    corners_.clear();
  }

  TextLines lines_;
  TriangleSoup soup_;
  std::vector<glm::dvec3> corners_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::uint32_t>> sets_;
  std::vector<std::uint32_t> of_triangle_;
  std::uint32_t set_ = 0;
  bool named_ = false;
};

}  // namespace

Mesh read_stl(const std::string& path, Notices& /*notices*/, std::stop_token stop) {
  InputFile file(path, std::move(stop));
  return is_binary(file) ? read_binary(file) : StlText(file).read();
}

}  // namespace detp::sim
