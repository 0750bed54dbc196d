#include "obj_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/unit_vector.hpp"
#include "file_error.hpp"
#include "mtl_file.hpp"
#include "number_text.hpp"
#include "polygon.hpp"
#include "statements.hpp"

namespace detp::sim {
namespace {

/// If the sum of n unit normals is shorter than n·least_sum, the normals count as cancelling: the sum is only rounding.
constexpr double least_sum = 1e-6;

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

  /// The sum; the first normal if the normals cancel, as at a plant's leaf that has one triangle for each side.
  [[nodiscard]] glm::dvec3 vector() const { return glm::length(sum) < least_sum * count ? first : sum; }
};

/// Lets a table with strings as keys be searched for a part of a line.
struct HashOfName {
  using is_transparent = void;
  std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>()(name); }
};

/// The paths that mtllib lines name, each once.
class Libraries {
 public:
  /// `names` is one name, which may contain blanks; if there is no such file, the words before a comment are names.
  void add(const std::string& obj, std::string_view names) {
    std::error_code ignored;
    const auto exists = [&](std::string_view name) { return std::filesystem::exists(beside(obj, name), ignored); };
    if (!exists(names)) names = without_comment(names);
    const bool is_one = exists(names);
    for (std::string_view words = names, word = is_one ? names : cut_word(words); !word.empty();
         word = is_one ? std::string_view{} : cut_word(words))
      if (known_.emplace(word).second) paths_.push_back(beside(obj, word));
  }
  /// In the order of the file.
  [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }

 private:
  std::vector<std::string> paths_;
  std::unordered_set<std::string> known_;
};

/// Indices of a face's corner as written in the file; 0: none.
struct Corner {
  long long vertex = 0;
  long long normal = 0;
};

class ObjReader {
 public:
  ObjReader(const std::string& path, std::stop_token stop)
      : path_(path),
        stop_(stop),
        lines_(path, obj_format, stop),
        memory_(path),
        check_(std::move(stop), "reading polygons") {}

  Mesh read(Notices& notices) {
    while (lines_.next()) {
      if (lines_.keyword() == "v") add_position();
      if (lines_.keyword() == "vn") add_normal();
      if (lines_.keyword() == "f" || lines_.keyword() == "fo") add_face();
      if (lines_.keyword() == "usemtl") use_material(lines_.name());
      if (lines_.keyword() == "mtllib") libraries_.add(path_, lines_.name());
    }
    if (needed_ > mesh_.positions.size())
      throw FileError(path_, line_of_needed_, out_of_range(static_cast<long long>(needed_), mesh_.positions.size()));
    lines_.note_unknown(notices);
    divide_late_polygons();
    mesh_.polygons = triangulator_.counts();
    add_materials(notices);
    add_normals();
    return std::move(mesh_);
  }

 private:
  void add_position() {
    memory_.push(mesh_.positions, vector_in_line());
    memory_.push(at_positions_, CornerNormals{});
  }

  void add_normal() {
    const glm::dvec3 normal = vector_in_line();
    const bool finite = std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z);
    memory_.push(normals_, finite ? unit_or_zero(normal) : glm::dvec3{0.0});
  }

  void add_face() {
    polygon_.clear();
    for (std::string_view words = lines_.rest(), word = cut_word(words); !word.empty(); word = cut_word(words))
      memory_.push(polygon_, add_corner(corner_in(word)));
    drop_repeated_corners(polygon_);
    if (polygon_.size() < 3) lines_.fail("a face needs at least 3 corners");
    const bool known = std::ranges::all_of(polygon_, [&](std::uint32_t one) { return one < mesh_.positions.size(); });
    if (known) return divide(mesh_.triangles.size());
    late_.push_back({mesh_.triangles.size(), polygon_});
    for (std::size_t i = 2; i < polygon_.size(); ++i)
      memory_.push(mesh_.triangles, {polygon_[0], polygon_[i - 1], polygon_[i]});
  }

  /// Puts the triangles of polygon_ at this place.
  void divide(std::size_t place) {
    for (const auto& triangle : triangulator_.triangles_of(polygon_, mesh_.positions, check_)) {
      if (place == mesh_.triangles.size())
        memory_.push(mesh_.triangles, triangle);
      else
        mesh_.triangles[place] = triangle;
      ++place;
    }
  }

  /// Those with corners that came after them.
  void divide_late_polygons() {
    for (auto& [place, corners] : late_) {
      polygon_ = std::move(corners);
      divide(place);
    }
  }

  /// Normals of corners, where some vertex has one. A vertex without one has 0.
  void add_normals() {
    if (!names_normals_) return;
    for (const auto& triangle : mesh_.triangles)
      for (const std::uint32_t corner : triangle) mesh_.normals_made += at_positions_[corner].count == 0 ? 1 : 0;
    if (mesh_.normals_made == 3 * mesh_.triangles.size()) return;
    memory_.reserve(mesh_.normals, at_positions_.size());
    for (const CornerNormals& normals : at_positions_) mesh_.normals.push_back(normals.vector());
  }

  /// The material of the faces that follow. Faces before the first one have number 0, that of no name.
  void use_material(std::string_view name) {
    if (runs_.empty()) memory_.push(runs_, {std::size_t{0}, std::uint16_t{0}});
    memory_.push(runs_, {mesh_.triangles.size(), number_of(name)});
  }

  /// The number of a material: the number of other names before it.
  std::uint16_t number_of(std::string_view name) {
    if (const auto known = numbers_.find(name); known != numbers_.end()) return known->second;
    if (names_.size() > UINT16_MAX) lines_.fail("a mesh can have 65535 materials");
    names_.emplace_back(name);
    return numbers_[names_.back()] = static_cast<std::uint16_t>(names_.size() - 1);
  }

  /// Reads the libraries, and gives each triangle its material. Without a library that can be found, all are matt.
  void add_materials(Notices& notices) {
    if (runs_.empty() || libraries_.paths().empty()) return;
    StopCheck check(stop_, "matching materials");
    std::vector<Material> defined;
    // Of names, and of what stands before a comment in them. The first one counts.
    std::unordered_map<std::string, std::size_t, HashOfName, std::equal_to<>> whole, bare;
    for (const std::string& library : libraries_.paths())
      for (Material& one : read_mtl(library, notices, stop_)) {
        check.after(1);
        whole.try_emplace(one.name, defined.size());
        bare.try_emplace(std::string(without_comment(one.name)), defined.size());
        defined.push_back(std::move(one));
      }
    if (defined.empty()) return;
    std::vector<Material> materials(names_.size());
    std::size_t unknown = 0;
    for (std::size_t i = 1; i < names_.size(); ++i) {
      const auto exact = whole.find(names_[i]);
      const auto before_comment = bare.find(without_comment(names_[i]));
      if (exact != whole.end())
        materials[i] = defined[exact->second];
      else if (before_comment != bare.end())
        materials[i] = defined[before_comment->second];
      else
        ++unknown;
    }
    mesh_.materials.all = std::move(materials);
    if (unknown > 0) notices.push_back("materials that no library defines, taken as matt: " + std::to_string(unknown));
    std::vector<std::uint16_t>& numbers = mesh_.materials.of_triangle;
    memory_.reserve(numbers, mesh_.triangles.size());
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      numbers.resize(i + 1 < runs_.size() ? runs_[i + 1].first : mesh_.triangles.size(), runs_[i].second);
      check.after(1);
    }
  }

  /// The first three numbers of a v or vn line.
  [[nodiscard]] glm::dvec3 vector_in_line() const {
    std::string_view words = lines_.rest();
    glm::dvec3 vector{0.0};
    for (int axis = 0; axis < 3; ++axis) vector[axis] = lines_.number(cut_word(words));
    return vector;
  }

  /// Reads 1, 1/2, 1//3 or 1/2/3: the vertex, its texture (ignored) and its normal.
  [[nodiscard]] Corner corner_in(std::string_view word) const {
    std::string_view parts = word;
    Corner corner{.vertex = index_in(cut_until(parts, "/"), word)};
    (void)index_in(cut_until(parts, "/"), word);
    corner.normal = index_in(parts, word);
    return corner;
  }

  [[nodiscard]] long long index_in(std::string_view digits, std::string_view word) const {
    if (digits.empty()) return 0;
    if (digits.front() == '+') digits.remove_prefix(1);
    long long index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error == std::errc{} && end == digits.data() + digits.size()) return index;
    if (error == std::errc::result_out_of_range) lines_.fail("an index of " + detp::quoted(word) + " is out of range");
    lines_.fail(detp::quoted(word) + " is not a corner of a face; expected a corner such as 1, 1/2, 1//3 or 1/2/3");
  }

  [[nodiscard]] static std::string out_of_range(long long vertex, std::size_t count) {
    return "vertex " + std::to_string(vertex) + " is out of range, there are " + std::to_string(count);
  }

  /// Converts an index of the file to an index from 0, perhaps of a vertex that comes later. In the file, positive indices count
  /// from 1, negative indices backwards from the latest vertex or normal, which is -1. Nothing if there can be none.
  [[nodiscard]] static std::optional<std::size_t> resolve(long long index, std::size_t count) {
    const auto size = static_cast<long long>(count);
    if (index == 0 || index < -size) return std::nullopt;
    return static_cast<std::size_t>(index < 0 ? size + index : index - 1);
  }

  std::uint32_t add_corner(const Corner& corner) {
    const auto position = resolve(corner.vertex, mesh_.positions.size());
    if (!position || *position > UINT32_MAX)  // a mesh can use so many
      lines_.fail(out_of_range(corner.vertex, mesh_.positions.size()) + " so far");
    if (*position >= std::max(mesh_.positions.size(), needed_)) {
      needed_ = *position + 1;
      line_of_needed_ = lines_.line();
    }
    add_normal_of(corner, *position);
    return static_cast<std::uint32_t>(*position);
  }

  /// Normals that are not there yet, or are zero or not finite, do not count, nor those of vertices that are not there yet.
  void add_normal_of(const Corner& corner, std::size_t position) {
    names_normals_ = names_normals_ || corner.normal != 0;
    const auto normal = resolve(corner.normal, normals_.size());
    if (!normal || *normal >= normals_.size() || position >= at_positions_.size()) return;
    if (normals_[*normal] != glm::dvec3{0.0}) at_positions_[position].add(normals_[*normal]);
  }

  const std::string& path_;
  std::stop_token stop_;
  Statements lines_;
  KeptMemory memory_;
  Mesh mesh_;
  std::vector<glm::dvec3> normals_;
  std::vector<CornerNormals> at_positions_;
  std::vector<std::uint32_t> polygon_;
  Triangulator triangulator_;
  StopCheck check_;
  /// First triangle and corners of polygons before some of their vertices.
  std::vector<std::pair<std::size_t, std::vector<std::uint32_t>>> late_;
  std::size_t needed_ = 0;  ///< number of vertices without which a face has no corner
  std::size_t line_of_needed_ = 0;
  bool names_normals_ = false;  ///< some corner does
  Libraries libraries_;
  std::vector<std::string> names_{""};  ///< of materials
  std::unordered_map<std::string, std::uint16_t, HashOfName, std::equal_to<>> numbers_{{"", 0}};
  std::vector<std::pair<std::size_t, std::uint16_t>> runs_;  ///< first triangle and material, in rising order
};

}  // namespace

Mesh read_obj(const std::string& path, Notices& notices, std::stop_token stop) {
  return ObjReader(path, std::move(stop)).read(notices);
}

std::vector<std::string> material_files(const std::string& path, std::stop_token stop) {
  Libraries libraries;
  for (Statements lines(path, obj_format, std::move(stop)); lines.next();)
    if (lines.keyword() == "mtllib") libraries.add(path, lines.name());
  return libraries.paths();
}

}  // namespace detp::sim
