#include "obj_file.hpp"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <streambuf>
#include <string_view>

#include "file_error.hpp"
#include "input_file.hpp"
#include "number_text.hpp"
#include "unit_vector.hpp"

namespace detp::sim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Below this share of its terms, a sum of unit normals is what cancellation left.
constexpr double least_sum = 1e-6;

/// A text as a stream that tells which line was read last.
class TextStream : public std::streambuf {
 public:
  explicit TextStream(std::string& text) : text_(text) { setg(text.data(), text.data(), text.data() + text.size()); }

  [[nodiscard]] std::string_view last_line() const {
    std::string_view read = text_.substr(0, static_cast<std::size_t>(gptr() - eback()));
    if (read.ends_with('\n')) read.remove_suffix(1);
    if (read.ends_with('\r')) read.remove_suffix(1);
    return read.substr(read.find_last_of("\r\n") + 1);
  }

  [[nodiscard]] std::size_t last_line_number() const {
    const auto end = static_cast<std::size_t>(last_line().data() - text_.data());
    std::size_t number = 1;
    for (std::size_t i = 0; i < end; ++i)
      if (text_[i] == '\n' || (text_[i] == '\r' && text_[i + 1] != '\n')) ++number;
    return number;
  }

 private:
  std::string_view text_;
};

/// The sum of the unit normals of the corners at a position.
struct CornerNormals {
  glm::dvec3 sum{0.0};
  glm::dvec3 first{0.0};
  double count = 0;

  void add(const glm::dvec3& normal) {
    if (count == 0) first = normal;
    sum += normal;
    ++count;
  }

  /// The sum, or where the normals cancel, as those of a leaf that is there once for each face, the first.
  [[nodiscard]] glm::dvec3 vector() const { return glm::length(sum) < least_sum * count ? first : sum; }
};

/// Takes what tinyobjloader finds.
///
/// The library splits the file into lines and faces into corners. It is lax about the rest: "nan" and "abc" are 0 to
/// it, its real_t is float or double as it was built, and indices it does not check. So numbers are read again here
/// from the line, always as doubles, and indices are checked as they come.
class ObjBuilder {
 public:
  ObjBuilder(const std::string& path, const TextStream& stream) : path_(path), stream_(stream) {}

  void add_position() {
    mesh_.positions.push_back(vector_in_line());
    at_positions_.emplace_back();
  }

  void add_normal() {
    const glm::dvec3 normal = vector_in_line();
    const bool finite = std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z);
    normals_.push_back(finite ? unit_or_zero(normal) : glm::dvec3{nan});
  }

  void add_face(const tinyobj::index_t* corners, int count) {
    check_face_line();
    if (count < 3) fail("a face needs at least 3 corners");
    std::vector<std::uint32_t> polygon;
    for (int i = 0; i < count; ++i) polygon.push_back(add_corner(corners[i]));
    for (std::size_t i = 2; i < polygon.size(); ++i)
      mesh_.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }

  [[nodiscard]] Mesh take_mesh() {
    if (!normals_.empty() && all_used_have_normals())
      for (const CornerNormals& normals : at_positions_) mesh_.normals.push_back(normals.vector());
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_, stream_.last_line_number(), what); }

  /// The first three numbers of a v or vn line.
  [[nodiscard]] glm::dvec3 vector_in_line() const {
    std::string_view line = stream_.last_line();
    (void)cut_word(line);
    glm::dvec3 vector{0.0};
    for (int axis = 0; axis < 3; ++axis) vector[axis] = number(cut_word(line));
    return vector;
  }

  [[nodiscard]] double number(std::string_view word) const {
    if (const auto value = number_in(word)) return *value;
    if (word.find("1.#") != std::string_view::npos) return nan;  // how older Microsoft libraries print NaN and infinity
    if (word.empty()) fail("has too few numbers, 3 are needed");
    fail("\"" + std::string(word) + "\" is not a number");
  }

  /// tinyobjloader takes 3 from "3x", and 1 from 4294967297.
  void check_face_line() const {
    std::string_view line = stream_.last_line();
    (void)cut_word(line);
    if (line.find_first_not_of("0123456789+-/ \t") != std::string_view::npos)
      fail("is no face; wanted are corners such as 1, 1/2, 1//3 or 1/2/3");
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto is_run = [&](auto first) { return std::all_of(first, first + 10, digit); };
    for (auto at = line.begin(); line.end() - at >= 10; ++at)
      if (is_run(at)) fail("has an index of 10 or more digits");
  }

  /// Of a corner as the file gives it: from 1, or from the last one so far backwards as a negative number.
  [[nodiscard]] std::size_t resolve(int index, std::size_t count, const char* what) const {
    const auto size = static_cast<long long>(count);
    const long long resolved = index < 0 ? size + index : index - 1LL;
    if (resolved < 0 || resolved >= size)
      fail(std::string(what) + " " + std::to_string(index) + " is out of range, there are " + std::to_string(count) +
           " so far");
    return static_cast<std::size_t>(resolved);
  }

  std::uint32_t add_corner(const tinyobj::index_t& corner) {
    const std::size_t position = resolve(corner.vertex_index, mesh_.positions.size(), "vertex");
    if (corner.normal_index != 0)
      at_positions_[position].add(normals_[resolve(corner.normal_index, normals_.size(), "normal")]);
    return static_cast<std::uint32_t>(position);
  }

  [[nodiscard]] bool all_used_have_normals() const {
    return std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(), [this](const auto& triangle) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [this](auto corner) { return at_positions_[corner].count > 0; });
    });
  }

  const std::string& path_;
  const TextStream& stream_;
  Mesh mesh_;
  std::vector<glm::dvec3> normals_;
  std::vector<CornerNormals> at_positions_;
};

}  // namespace

Mesh read_obj(const std::string& path) {
  std::string text = read_file(path);
  TextStream stream(text);
  ObjBuilder builder(path, stream);
  tinyobj::callback_t callback;
  callback.vertex_cb = [](void* to, auto...) { static_cast<ObjBuilder*>(to)->add_position(); };
  callback.normal_cb = [](void* to, auto...) { static_cast<ObjBuilder*>(to)->add_normal(); };
  callback.index_cb = [](void* to, tinyobj::index_t* corners, int count) {
    static_cast<ObjBuilder*>(to)->add_face(corners, count);
  };
  std::istream lines(&stream);
  tinyobj::LoadObjWithCallback(lines, callback, &builder);
  return builder.take_mesh();
}

}  // namespace detp::sim
