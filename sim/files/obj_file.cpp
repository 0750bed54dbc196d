#include "obj_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
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
#include "statements.hpp"

namespace detp::sim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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
  /// `names` is one name, which may contain blanks; if there is no such file, the words are names.
  void add(const std::string& obj, std::string_view names) {
    std::error_code ignored;
    const bool is_one = std::filesystem::exists(beside(obj, names), ignored);
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
      : path_(path), stop_(stop), lines_(path, obj_format, std::move(stop)), memory_(path) {}

  Mesh read(Notices& notices) {
    while (lines_.next()) {
      if (lines_.keyword() == "v") add_position();
      if (lines_.keyword() == "vn") add_normal();
      if (lines_.keyword() == "f") add_face();
      if (lines_.keyword() == "usemtl") use_material(trimmed(lines_.rest()));
      if (lines_.keyword() == "mtllib") libraries_.add(path_, trimmed(lines_.rest()));
    }
    lines_.note_unknown(notices);
    add_materials(notices);
    if (!normals_.empty() && all_used_have_normals()) {
      memory_.reserve(mesh_.normals, at_positions_.size());
      for (const CornerNormals& normals : at_positions_) mesh_.normals.push_back(normals.vector());
    }
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
    memory_.push(normals_, finite ? unit_or_zero(normal) : glm::dvec3{nan});
  }

  void add_face() {
    polygon_.clear();
    for (std::string_view words = lines_.rest(), word = cut_word(words); !word.empty(); word = cut_word(words))
      memory_.push(polygon_, add_corner(corner_in(word)));
    if (polygon_.size() < 3) lines_.fail("a face needs at least 3 corners");
    for (std::size_t i = 2; i < polygon_.size(); ++i)
      memory_.push(mesh_.triangles, {polygon_[0], polygon_[i - 1], polygon_[i]});
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
    std::vector<Material> materials(names_.size());
    std::vector<bool> defined(names_.size());
    bool some = false;
    for (const std::string& library : libraries_.paths())
      for (Material& one : read_mtl(library, notices, stop_)) {
        check.after(1);
        some = true;
        const auto used = numbers_.find(one.name);
        if (used == numbers_.end() || used->second == 0 || defined[used->second]) continue;  // the first one counts
        defined[used->second] = true;
        materials[used->second] = std::move(one);
      }
    if (!some) return;
    mesh_.materials.all = std::move(materials);
    const auto unknown = std::count(defined.begin() + 1, defined.end(), false);
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

  /// Converts an index of the file to an index from 0. In the file, positive indices count from 1, negative indices
  /// backwards from the latest vertex or normal, which is -1.
  [[nodiscard]] std::size_t resolve(long long index, std::size_t count, const char* what) const {
    const auto size = static_cast<long long>(count);
    const bool in_range = index != 0 && index >= -size && index <= size;
    if (!in_range)
      lines_.fail(std::string(what) + " " + std::to_string(index) + " is out of range, there are " +
                  std::to_string(count) + " so far");
    return static_cast<std::size_t>(index < 0 ? size + index : index - 1);
  }

  std::uint32_t add_corner(const Corner& corner) {
    const std::size_t position = resolve(corner.vertex, mesh_.positions.size(), "vertex");
    if (position > UINT32_MAX) lines_.fail("a mesh can use the first 4294967295 vertices only");
    if (corner.normal != 0) at_positions_[position].add(normals_[resolve(corner.normal, normals_.size(), "normal")]);
    return static_cast<std::uint32_t>(position);
  }

  [[nodiscard]] bool all_used_have_normals() const {
    return std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(), [this](const auto& triangle) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [this](auto corner) { return at_positions_[corner].count > 0; });
    });
  }

  const std::string& path_;
  std::stop_token stop_;
  Statements lines_;
  KeptMemory memory_;
  Mesh mesh_;
  std::vector<glm::dvec3> normals_;
  std::vector<CornerNormals> at_positions_;
  std::vector<std::uint32_t> polygon_;
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
    if (lines.keyword() == "mtllib") libraries.add(path, trimmed(lines.rest()));
  return libraries.paths();
}

}  // namespace detp::sim
