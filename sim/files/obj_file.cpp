#include "obj_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "file_error.hpp"
#include "mtl_file.hpp"
#include "number_text.hpp"
#include "polygon.hpp"
#include "statements.hpp"

namespace detp::sim {
namespace {

/// Lets a table with strings as keys be searched for a part of a line.
struct HashOfName {
  using is_transparent = void;
  std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>()(name); }
};

/// Numbers names in the order of their first use.
class NameNumbers {
 public:
  std::uint32_t number_of(std::string_view name) {
    if (const auto known = numbers_.find(name); known != numbers_.end()) return known->second;
    names_.emplace_back(name);
    return numbers_[names_.back()] = static_cast<std::uint32_t>(names_.size() - 1);
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::uint32_t, HashOfName, std::equal_to<>> numbers_;
};

/// First triangle and number of what the triangles up to the next run have; in rising order.
template <class Number>
using Runs = std::vector<std::pair<std::size_t, Number>>;

/// Gives each of so many triangles the number of its run.
template <class Number>
std::vector<Number> spread(const Runs<Number>& runs, std::size_t triangles, KeptMemory& memory, StopCheck& check) {
  std::vector<Number> numbers;
  memory.reserve(numbers, triangles);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    numbers.resize(i + 1 < runs.size() ? runs[i + 1].first : triangles, runs[i].second);
    check.after(1);
  }
  return numbers;
}

/// The groups of faces by the last `o` and the last `g` before them.
class ObjGroups {
 public:
  static constexpr std::size_t most = 100;  ///< names in a `g`, so that memory grows with the file only

  /// A name, which may contain blanks; none: the faces that follow are of no object.
  void begin_object(std::string_view name) {
    object_.clear();
    if (!name.empty()) object_.push_back(names_.number_of(name));
    is_new_ = true;
  }

  /// Names with blanks between them. Returns false if there are too many.
  bool begin_groups(std::string_view words) {
    groups_.clear();
    for (std::string_view word = words.empty() ? "default" : cut_word(words); !word.empty(); word = cut_word(words)) {
      if (groups_.size() == most) return false;
      groups_.push_back(names_.number_of(word));
    }
    is_new_ = true;
    return true;
  }

  /// Takes the first triangle of a face.
  void add_face(std::size_t triangle, KeptMemory& memory) {
    if (!std::exchange(is_new_, false)) return;
    std::vector<std::uint32_t> set = groups_;
    set.insert(set.end(), object_.begin(), object_.end());
    std::ranges::sort(set);
    set.erase(std::unique(set.begin(), set.end()), set.end());
    const auto number = static_cast<std::uint32_t>(sets_.size());
    memory.push(runs_, {triangle, sets_.try_emplace(std::move(set), number).first->second});
  }

  /// None if no face has a name.
  [[nodiscard]] Groups of(std::size_t triangles, KeptMemory& memory, StopCheck& check) const {
    if (sets_.empty() || sets_.rbegin()->first.empty()) return {};
    Groups groups{.names = names_.names(), .of_triangle = spread(runs_, triangles, memory, check)};
    groups.sets.resize(sets_.size());
    for (const auto& [set, number] : sets_) groups.sets[number] = set;
    return groups;
  }

 private:
  NameNumbers names_;
  std::vector<std::uint32_t> object_;  ///< its number, if there is one
  std::vector<std::uint32_t> groups_;
  bool is_new_ = true;  ///< since the last face
  std::map<std::vector<std::uint32_t>, std::uint32_t> sets_;
  Runs<std::uint32_t> runs_;
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
struct WrittenCorner {
  long long vertex = 0;
  long long normal = 0;
};

constexpr std::uint32_t no_normal = UINT32_MAX;

/// Indices from 0.
struct Corner {
  std::uint32_t position = 0;
  std::uint32_t normal = no_normal;

  bool operator==(const Corner&) const = default;
};

/// Vertices with one position and one normal. The first one of each position has its number, others follow all positions.
class ObjVertices {
 public:
  void add_position(KeptMemory& memory) { memory.push(first_normals_, std::uint32_t{unused}); }

  /// The position must be there. Vertices that follow the positions are counted from `others`.
  [[nodiscard]] std::uint32_t number_of(const Corner& corner) {
    std::uint32_t& first = first_normals_[corner.position];
    if (first == unused) first = corner.normal;
    if (first == corner.normal) return corner.position;
    const std::uint64_t key = (std::uint64_t{corner.position} << 32) | corner.normal;
    const auto [found, is_new] = numbers_.try_emplace(key, static_cast<std::uint32_t>(more_.size()));
    if (is_new) more_.push_back(corner);
    return others + found->second;
  }

  /// The normal of a vertex that has a position's number.
  [[nodiscard]] std::uint32_t normal_of(std::size_t position) const {
    return first_normals_[position] == unused ? no_normal : first_normals_[position];
  }
  [[nodiscard]] const std::vector<Corner>& more() const { return more_; }

  static constexpr std::uint32_t others = std::uint32_t{1} << 31;

 private:
  static constexpr std::uint32_t unused = UINT32_MAX - 1;
  std::vector<std::uint32_t> first_normals_;
  std::vector<Corner> more_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
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
      const std::string_view keyword = lines_.keyword();
      if (keyword == "v")
        add_position();
      else if (keyword == "f" || keyword == "fo")
        add_face();
      else if (keyword == "vn")
        add_normal();
      else if (keyword == "o")
        groups_.begin_object(without_comment(lines_.name()));
      else if (keyword == "g")
        begin_groups();
      else if (keyword == "usemtl")
        use_material(lines_.name());
      else if (keyword == "mtllib")
        libraries_.add(path_, lines_.name());
    }
    if (needed_ > mesh_.positions.size())
      throw FileError(path_, line_of_needed_, out_of_range(static_cast<long long>(needed_), mesh_.positions.size()));
    lines_.note_unknown(notices);
    divide_late_polygons();
    mesh_.polygons = triangulator_.counts();
    add_materials(notices);
    StopCheck check(stop_, "matching groups");
    mesh_.groups = groups_.of(mesh_.triangles.size(), memory_, check);
    add_vertices();
    return std::move(mesh_);
  }

 private:
  void add_position() {
    memory_.push(mesh_.positions, vector_in_line());
    vertices_.add_position(memory_);
  }

  void add_normal() {
    const glm::dvec3 normal = vector_in_line();
    const bool finite = std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z);
    memory_.push(normals_, finite ? unit_or_zero(normal) : glm::dvec3{0.0});
  }

  void add_face() {
    corners_.clear();
    for (std::string_view words = lines_.rest(), word = cut_word(words); !word.empty(); word = cut_word(words))
      memory_.push(corners_, corner_of(corner_in(word)));
    drop_repeated_corners(corners_, &Corner::position);
    if (corners_.size() < 3) lines_.fail("a face needs at least 3 corners");
    groups_.add_face(mesh_.triangles.size(), memory_);
    const bool known = std::ranges::all_of(corners_, [&](const Corner& one) {
      return one.position < mesh_.positions.size() && (one.normal == no_normal || one.normal < normals_.size());
    });
    if (known) return divide(corners_, mesh_.triangles.size());
    late_.push_back({mesh_.triangles.size(), corners_});
    for (std::size_t i = 2; i < corners_.size(); ++i) memory_.push(mesh_.triangles, {0, 0, 0});
  }

  /// Puts the triangles of a polygon at this place.
  void divide(const std::vector<Corner>& corners, std::size_t place) {
    polygon_.clear();
    outline_.clear();
    for (Corner corner : corners) {
      if (corner.normal != no_normal && !has_length(corner.normal)) corner.normal = no_normal;
      polygon_.push_back(vertices_.number_of(corner));
      outline_.push_back(mesh_.positions[corner.position]);
    }
    triangles_.clear();
    triangulator_.divide(outline_, check_, triangles_);
    for (auto& triangle : triangles_) {
      for (std::uint32_t& corner : triangle) corner = polygon_[corner];
      if (place == mesh_.triangles.size())
        memory_.push(mesh_.triangles, triangle);
      else
        mesh_.triangles[place] = triangle;
      ++place;
    }
  }

  /// Those with positions or normals that came after them.
  void divide_late_polygons() {
    for (const auto& [place, corners] : late_) divide(corners, place);
  }

  /// Whether the normal is there, and neither zero nor not finite.
  [[nodiscard]] bool has_length(std::uint32_t normal) const {
    return normal < normals_.size() && normals_[normal] != glm::dvec3{0.0};
  }

  /// Gives vertices their last numbers and, where some corner has a normal, their normals: 0 if they have none.
  void add_vertices() {
    const std::size_t positions = mesh_.positions.size();
    const std::vector<Corner>& more = vertices_.more();
    if (!more.empty()) {
      memory_.reserve(mesh_.file_vertices, positions + more.size());
      memory_.reserve(mesh_.positions, positions + more.size());
      for (std::size_t i = 0; i < positions; ++i) mesh_.file_vertices.push_back(static_cast<std::uint32_t>(i));
      for (const Corner& corner : more) {
        mesh_.positions.push_back(glm::dvec3(mesh_.positions[corner.position]));
        mesh_.file_vertices.push_back(corner.position);
      }
      for (auto& triangle : mesh_.triangles)
        for (std::uint32_t& corner : triangle)
          if (corner >= ObjVertices::others)
            corner = static_cast<std::uint32_t>(positions + (corner - ObjVertices::others));
    }
    if (!names_normals_) return;
    const auto normal_of = [&](std::size_t vertex) {
      const std::uint32_t normal = vertex < positions ? vertices_.normal_of(vertex) : more[vertex - positions].normal;
      return normal == no_normal ? glm::dvec3{0.0} : normals_[normal];
    };
    for (const auto& triangle : mesh_.triangles)
      for (const std::uint32_t corner : triangle) mesh_.normals_made += normal_of(corner) == glm::dvec3{0.0} ? 1 : 0;
    if (mesh_.normals_made == 3 * mesh_.triangles.size()) return;
    memory_.reserve(mesh_.normals, mesh_.positions.size());
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i) mesh_.normals.push_back(normal_of(i));
  }

  void begin_groups() {
    if (!groups_.begin_groups(without_comment(lines_.name())))
      lines_.fail(fmt::format("a face can be in {} groups", ObjGroups::most));
  }

  /// The material of the faces that follow. Faces before the first one have number 0, that of no name.
  void use_material(std::string_view name) {
    if (runs_.empty()) memory_.push(runs_, {std::size_t{0}, number_of("")});
    memory_.push(runs_, {mesh_.triangles.size(), number_of(name)});
  }

  /// The number of a material: the number of other names before it.
  std::uint16_t number_of(std::string_view name) {
    const std::uint32_t number = materials_.number_of(name);
    if (number > UINT16_MAX) lines_.fail("a mesh can have 65535 materials");
    return static_cast<std::uint16_t>(number);
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
    const std::vector<std::string>& names = materials_.names();
    std::vector<Material> materials(names.size());
    std::size_t unknown = 0;
    for (std::size_t i = 1; i < names.size(); ++i) {
      const auto exact = whole.find(names[i]);
      const auto before_comment = bare.find(without_comment(names[i]));
      materials[i].name = names[i];
      if (exact != whole.end())
        materials[i] = defined[exact->second];
      else if (before_comment != bare.end())
        materials[i] = defined[before_comment->second];
      else
        ++unknown;
    }
    mesh_.materials.all = std::move(materials);
    if (unknown > 0) notices.push_back("materials that no library defines, taken as matt: " + std::to_string(unknown));
    mesh_.materials.of_triangle = spread(runs_, mesh_.triangles.size(), memory_, check);
  }

  /// The first three numbers of a v or vn line.
  [[nodiscard]] glm::dvec3 vector_in_line() const {
    std::string_view words = lines_.rest();
    glm::dvec3 vector{0.0};
    for (int axis = 0; axis < 3; ++axis) vector[axis] = lines_.number(cut_word(words));
    return vector;
  }

  /// Reads 1, 1/2, 1//3 or 1/2/3: the vertex, its texture (ignored) and its normal.
  [[nodiscard]] WrittenCorner corner_in(std::string_view word) const {
    std::string_view parts = word;
    WrittenCorner corner{.vertex = index_in(cut_until(parts, "/"), word)};
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

  [[nodiscard]] Corner corner_of(const WrittenCorner& written) {
    const auto position = resolve(written.vertex, mesh_.positions.size());
    if (!position || *position >= ObjVertices::others)  // a mesh can use so many
      lines_.fail(out_of_range(written.vertex, mesh_.positions.size()) + " so far");
    if (*position >= std::max(mesh_.positions.size(), needed_)) {
      needed_ = *position + 1;
      line_of_needed_ = lines_.line();
    }
    names_normals_ = names_normals_ || written.normal != 0;
    const auto normal = resolve(written.normal, normals_.size());
    const bool may_be = normal && *normal < ObjVertices::others;
    return {static_cast<std::uint32_t>(*position), may_be ? static_cast<std::uint32_t>(*normal) : no_normal};
  }

  const std::string& path_;
  std::stop_token stop_;
  Statements lines_;
  KeptMemory memory_;
  Mesh mesh_;
  std::vector<glm::dvec3> normals_;
  ObjVertices vertices_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> polygon_;  ///< vertices
  std::vector<glm::dvec3> outline_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  Triangulator triangulator_;
  StopCheck check_;
  /// First triangle and corners of polygons before some of their positions or normals.
  std::vector<std::pair<std::size_t, std::vector<Corner>>> late_;
  std::size_t needed_ = 0;  ///< number of vertices without which a face has no corner
  std::size_t line_of_needed_ = 0;
  bool names_normals_ = false;  ///< some corner does
  Libraries libraries_;
  ObjGroups groups_;
  NameNumbers materials_;
  Runs<std::uint16_t> runs_;  ///< of materials
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
