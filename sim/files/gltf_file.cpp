#include "gltf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "gltf_document.hpp"
#include "gltf_material.hpp"

namespace detp::sim {
namespace {

using Json = nlohmann::json;

class GltfReader {
 public:
  GltfReader(const std::string& path, std::stop_token stop)
      : path_(path), document_(path, stop), memory_(path), check_(std::move(stop), "reading glTF") {}

  Mesh read(Notices& notices) {
    for (const Json& one : document_.list("materials")) mesh_.materials.all.push_back(gltf_material(one, left_out_));
    visited_.resize(document_.list("nodes").size());
    for (const std::size_t root : roots()) add_node(root, glm::dmat4(1.0));
    finish_materials();
    note(notices);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::vector<std::size_t> roots() const {
    std::vector<std::size_t> all;
    const Json& scenes = document_.list("scenes");
    if (!scenes.empty()) {
      const std::size_t scene = document_.whole(document_.json(), "scene").value_or(0);
      if (scene >= scenes.size())
        document_.fail(fmt::format("scene {} is not there: there are {}", scene, scenes.size()));
      return document_.indices_in(scenes[scene], "nodes");
    }
    std::vector<bool> is_child(document_.list("nodes").size());
    for (const Json& node : document_.list("nodes"))
      for (const std::size_t child : document_.indices_in(node, "children"))
        if (child < is_child.size()) is_child[child] = true;
    for (std::size_t node = 0; node < is_child.size(); ++node)
      if (!is_child[node]) all.push_back(node);
    return all;
  }

  [[nodiscard]] glm::dmat4 matrix_of(const Json& node) const {
    glm::dmat4 matrix(1.0);
    if (const auto m = document_.numbers_in(node, "matrix", 16); !m.empty()) {
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
      return matrix;
    }
    if (const auto q = document_.numbers_in(node, "rotation", 4); !q.empty()) {
      const double x = q[0];
      const double y = q[1];
      const double z = q[2];
      const double w = q[3];
      matrix[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
      matrix[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
      matrix[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
    }
    if (const auto s = document_.numbers_in(node, "scale", 3); !s.empty())
      for (int axis = 0; axis < 3; ++axis) matrix[axis] *= s[static_cast<std::size_t>(axis)];
    if (const auto t = document_.numbers_in(node, "translation", 3); !t.empty()) matrix[3] = {t[0], t[1], t[2], 1};
    return matrix;
  }

  static std::string name_of(const Json& object) {
    const auto found = object.find("name");
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
  }

  void add_node(std::size_t first, const glm::dmat4& place) {
    std::vector<std::pair<std::size_t, glm::dmat4>> open{{first, place}};
    while (!open.empty()) {
      const auto [number, parent] = open.back();
      open.pop_back();
      const Json& nodes = document_.list("nodes");
      if (number >= nodes.size() || !nodes[number].is_object())
        document_.fail(fmt::format("node {} is not there: there are {}", number, nodes.size()));
      if (visited_[number]) document_.fail(fmt::format("node {} is in two places, or contains itself", number));
      visited_[number] = true;
      const Json& node = nodes[number];
      const glm::dmat4 matrix = parent * matrix_of(node);
      if (node.contains("skin")) ++left_out_["skins"];
      if (const Json* mesh = document_.referred(node, "mesh", "meshes"))
        add_mesh(*mesh, matrix, group_set(node, *mesh));
      std::vector<std::size_t> children = document_.indices_in(node, "children");
      std::ranges::reverse(children);
      for (const std::size_t child : children) open.emplace_back(child, matrix);
    }
  }

  /// The set of the node's and the mesh's names.
  std::uint32_t group_set(const Json& node, const Json& mesh) {
    std::vector<std::uint32_t> set;
    for (const std::string& name : {name_of(node), name_of(mesh)}) {
      if (name.empty()) continue;
      const auto [found, is_new] = groups_.try_emplace(name, static_cast<std::uint32_t>(mesh_.groups.names.size()));
      if (is_new) mesh_.groups.names.push_back(name);
      set.push_back(found->second);
    }
    std::ranges::sort(set);
    set.erase(std::unique(set.begin(), set.end()), set.end());
    mesh_.groups.sets.push_back(std::move(set));
    return static_cast<std::uint32_t>(mesh_.groups.sets.size() - 1);
  }

  void add_mesh(const Json& mesh, const glm::dmat4& matrix, std::uint32_t set) {
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) document_.fail("a mesh has no primitives");
    for (const Json& one : *primitives) {
      if (!one.is_object()) document_.fail("a primitive is no object");
      add_primitive(one, matrix, set);
    }
  }

  void add_primitive(const Json& primitive, const glm::dmat4& matrix, std::uint32_t set) {
    enum Mode : std::size_t { triangles = 4, strip, fan };
    const std::size_t mode = document_.whole(primitive, "mode").value_or(triangles);
    if (mode < triangles || mode > fan) {
      ++left_out_["points and lines"];
      return;
    }
    if (primitive.contains("targets")) ++left_out_["morph targets"];
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) document_.fail("a primitive has no attributes");
    const std::optional<GltfRows> positions = document_.rows(*attributes, "POSITION", 3);
    if (!positions) return;
    const std::optional<GltfRows> normals = document_.rows(*attributes, "NORMAL", 3);
    const std::size_t base = mesh_.positions.size();
    if (base + positions->count > UINT32_MAX) document_.fail("has more vertices than 2^32");
    add_vertices(*positions, normals, matrix);
    const std::optional<GltfRows> indices = document_.rows(primitive, "indices", 1);
    const std::size_t count = indices ? indices->count : positions->count;
    const auto corner = [&](std::size_t i) {
      const double index = indices ? indices->at(i, 0) : static_cast<double>(i);
      if (!(index < static_cast<double>(positions->count)))
        document_.fail(fmt::format("index {} is out of range: a primitive has {} vertices", index, positions->count));
      return static_cast<std::uint32_t>(base + static_cast<std::size_t>(index));
    };
    const bool mirrored = glm::determinant(glm::dmat3(matrix)) < 0;
    const std::size_t number = mode == triangles ? count / 3 : count < 3 ? 0 : count - 2;
    for (std::size_t i = 0; i < number; ++i) {
      check_.after(1);
      std::array<std::uint32_t, 3> triangle = mode == triangles
                                                  ? std::array{corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)}
                                              : mode == fan ? std::array{corner(i + 1), corner(i + 2), corner(0)}
                                              : i % 2 == 0  ? std::array{corner(i), corner(i + 1), corner(i + 2)}
                                                            : std::array{corner(i + 1), corner(i), corner(i + 2)};
      const auto& [a, b, c] = triangle;
      if (mode != triangles && (a == b || b == c || c == a)) continue;  // a strip turns by corners that are repeated
      if (mirrored) std::swap(triangle[1], triangle[2]);
      memory_.push(mesh_.triangles, triangle);
    }
    (void)document_.referred(primitive, "material", "materials");
    const auto material = document_.whole(primitive, "material").value_or(no_material);
    of_triangle_.emplace_back(mesh_.triangles.size(), material);
    mesh_.groups.of_triangle.resize(mesh_.triangles.size(), set);
  }

  void add_vertices(const GltfRows& positions, const std::optional<GltfRows>& normals, const glm::dmat4& matrix) {
    if (normals && normals->count != positions.count)
      document_.fail("a primitive has not as many normals as positions");
    const glm::dmat3 linear(matrix);
    // Normals turn with the areas of their surfaces, also where a matrix makes the surface flat.
    const glm::dmat3 of_normals(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                glm::cross(linear[0], linear[1]));
    const double side = glm::determinant(linear) < 0 ? -1 : 1;
    has_normals_ = has_normals_ || normals;
    for (std::size_t i = 0; i < positions.count; ++i) {
      check_.after(1);
      memory_.push(mesh_.positions, glm::dvec3(matrix * glm::dvec4(positions.vector(i), 1.0)));
      memory_.push(normals_, normals ? side * (of_normals * normals->vector(i)) : glm::dvec3(0.0));
    }
  }

  void finish_materials() {
    if (has_normals_) mesh_.normals = std::move(normals_);
    if (std::ranges::all_of(mesh_.groups.sets, &std::vector<std::uint32_t>::empty)) mesh_.groups = {};
    Materials& materials = mesh_.materials;
    const auto is_without = [](const auto& one) { return one.second == no_material; };
    if (std::ranges::all_of(of_triangle_, is_without)) {
      materials = {};
      return;
    }
    std::size_t matt_one = materials.all.size();
    if (std::ranges::any_of(of_triangle_, is_without)) materials.all.push_back(matt);
    if (materials.all.size() > no_back)
      document_.fail(fmt::format("has {} materials, which are too many", materials.all.size()));
    for (const auto& [end, material] : of_triangle_)
      materials.of_triangle.resize(end, static_cast<std::uint16_t>(material == no_material ? matt_one : material));
  }

  void note(Notices& notices) {
    for (const auto& [name, what] : std::array<std::pair<const char*, const char*>, 3>{
             {{"cameras", "cameras"}, {"animations", "animations"}, {"textures", "textures"}}})
      if (!document_.list(name).empty()) left_out_[what] += document_.list(name).size();
    if (const auto extensions = document_.json().find("extensions");
        extensions != document_.json().end() && extensions->contains("KHR_lights_punctual"))
      ++left_out_["lights (KHR_lights_punctual)"];
    for (const auto& [what, count] : left_out_)
      notices.push_back(fmt::format("{}: {}, left out: {}", shown_path(path_), what, count));
  }

  static constexpr std::size_t no_material = SIZE_MAX;

  const std::string& path_;
  GltfDocument document_;
  KeptMemory memory_;
  StopCheck check_;
  std::vector<bool> visited_;
  Mesh mesh_;
  std::vector<glm::dvec3> normals_;
  bool has_normals_ = false;
  std::vector<std::pair<std::size_t, std::size_t>> of_triangle_;  ///< end of a run of triangles, and its material
  std::map<std::string, std::uint32_t> groups_;
  LeftOut left_out_;
};

}  // namespace

Mesh read_gltf(const std::string& path, Notices& notices, std::stop_token stop) {
  Mesh mesh = GltfReader(path, std::move(stop)).read(notices);
  return mesh;
}

std::vector<std::string> gltf_buffers(const std::string& path, std::stop_token stop) {
  return GltfDocument(path, stop, false).buffer_files();
}

}  // namespace detp::sim
