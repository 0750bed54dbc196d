#include "gltf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "detp/model/vocabulary/quoted.hpp"
#include "detp/sim/base/kept_memory.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "file_error.hpp"
#include "gltf_material.hpp"
#include "input_file.hpp"
#include "mtl_file.hpp"
#include "number_bytes.hpp"

namespace detp::sim {
namespace {

using Json = nlohmann::json;

/// Numbers in a buffer: `count` rows of `components` numbers.
struct Rows {
  const char* first = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;
  std::size_t components = 1;
  NumberType type = NumberType::float32;
  double divisor = 1;  ///< of whole numbers that stand for shares

  [[nodiscard]] double at(std::size_t row, std::size_t component) const {
    constexpr bool swapped = std::endian::native != std::endian::little;
    const double number = number_at(first + row * stride + component * size_of(type), type, swapped);
    return divisor == 1 ? number : std::max(number / divisor, -1.0);
  }
  [[nodiscard]] glm::dvec3 vector(std::size_t row) const { return {at(row, 0), at(row, 1), at(row, 2)}; }
};

std::string without_percents(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto is_hex = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
    if (uri[i] == '%' && i + 2 < uri.size() && is_hex(uri[i + 1]) && is_hex(uri[i + 2])) {
      text += static_cast<char>(std::stoi(std::string(uri.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find_last_not_of('=') + 1)) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

std::size_t most_bytes() { return static_cast<std::size_t>(memory_budget()); }

/// JSON, and the binary part of a .glb.
struct GltfText {
  Json json;
  std::optional<std::string> binary = {};
};

Json parsed(const std::string& path, std::string_view text) {
  const auto fail = [&](const std::string& why) { throw FileError(path, "is no glTF: " + why); };
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    fail(fmt::format("its JSON has an error near byte {}", std::string_view(error.what()).find("byte")));
  }
  if (!json.is_object() || !json.contains("asset")) fail("its JSON has no member asset");
  const Json& version = json["asset"].is_object() ? json["asset"].value("version", Json()) : Json();
  if (!version.is_string() || !version.get<std::string>().starts_with("2."))
    fail(fmt::format("version 2.x is read (got {})", detp::quoted(version.dump())));
  return json;
}

GltfText read_text(const std::string& path, std::stop_token stop) {
  std::string content = read_file(path, most_bytes(), std::move(stop));
  if (!content.starts_with("glTF")) return {parsed(path, content)};
  constexpr bool swapped = std::endian::native != std::endian::little;
  GltfText text;
  bool has_json = false;
  for (std::size_t at = 12; at < content.size();) {
    if (content.size() - at < 8) throw FileError(path, "ends early, within the head of a chunk");
    const auto length = static_cast<std::size_t>(number_at(content.data() + at, NumberType::uint32, swapped));
    const std::string_view kind = std::string_view(content).substr(at + 4, 4);
    at += 8;
    if (length > content.size() - at) throw FileError(path, "ends early, within a chunk");
    if (kind == "JSON" && !has_json) {
      text.json = parsed(path, std::string_view(content).substr(at, length));
      has_json = true;
    } else if (kind == std::string_view("BIN\0", 4) && !text.binary) {
      text.binary = content.substr(at, length);
    }
    at += length;
  }
  if (!has_json) throw FileError(path, "has no chunk of JSON");
  return text;
}

/// Whether a buffer is in the JSON itself.
bool is_data(std::string_view uri) { return uri.starts_with("data:"); }

class GltfReader {
 public:
  GltfReader(const std::string& path, std::stop_token stop)
      : path_(path),
        stop_(stop),
        text_(read_text(path, stop)),
        memory_(path),
        check_(std::move(stop), "reading glTF") {}

  Mesh read(Notices& notices) {
    refuse_extensions();
    read_buffers();
    for (const Json& one : list("materials")) mesh_.materials.all.push_back(gltf_material(one, left_out_));
    visited_.resize(list("nodes").size());
    for (const std::size_t root : roots()) add_node(root, glm::dmat4(1.0));
    finish_materials();
    note(notices);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_, what); }

  /// A list of the whole file; empty if there is none.
  [[nodiscard]] const Json& list(const char* name) const {
    static const Json none = Json::array();
    const auto found = text_.json.find(name);
    if (found == text_.json.end()) return none;
    if (!found->is_array()) fail(fmt::format("{} is no list", name));
    return *found;
  }

  /// The object that a number in `from` refers to; null if there is none.
  [[nodiscard]] const Json* referred(const Json& from, const char* key, const char* name) const {
    const auto index = whole(from, key);
    if (!index) return nullptr;
    const Json& all = list(name);
    if (*index >= all.size() || !all[*index].is_object())
      fail(fmt::format("{} {} is not there: there are {}", name, *index, all.size()));
    return &all[*index];
  }

  [[nodiscard]] std::optional<std::size_t> whole(const Json& from, const char* key) const {
    const auto found = from.find(key);
    if (found == from.end()) return std::nullopt;
    if (!found->is_number_unsigned()) fail(fmt::format("{} is no whole number", key));
    return found->get<std::size_t>();
  }

  void refuse_extensions() {
    constexpr std::array changing{"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing",
                                  "KHR_meshopt_compression"};
    for (const Json& one : list("extensionsRequired"))
      if (one.is_string() && std::ranges::find(changing, one.get<std::string>()) != changing.end())
        fail(fmt::format("needs {}, which is not read: export it without", one.get<std::string>()));
  }

  void read_buffers() {
    for (const Json& one : list("buffers")) {
      const auto length = one.is_object() ? whole(one, "byteLength") : std::nullopt;
      if (!length) fail("a buffer has no byteLength");
      std::string& bytes = buffers_.emplace_back();
      if (const auto uri = one.find("uri"); uri != one.end() && uri->is_string())
        bytes = bytes_of(uri->get<std::string>());
      else if (text_.binary)
        bytes = std::move(*std::exchange(text_.binary, std::nullopt));
      if (bytes.size() < *length)
        fail(fmt::format("buffer {} has {} bytes; {} are needed", buffers_.size() - 1, bytes.size(), *length));
    }
  }

  [[nodiscard]] std::string bytes_of(const std::string& uri) const {
    if (!is_data(uri)) return read_file(beside(path_, without_percents(uri)), most_bytes(), stop_);
    const std::size_t comma = uri.find(',');
    const auto bytes = comma != std::string::npos && uri.substr(0, comma).ends_with(";base64")
                           ? from_base64(std::string_view(uri).substr(comma + 1))
                           : std::nullopt;
    if (!bytes) fail("a buffer in the file itself is not in base64");
    return *bytes;
  }

  [[nodiscard]] std::vector<std::size_t> roots() const {
    std::vector<std::size_t> all;
    const Json& scenes = list("scenes");
    if (!scenes.empty()) {
      const std::size_t scene = whole(text_.json, "scene").value_or(0);
      if (scene >= scenes.size()) fail(fmt::format("scene {} is not there: there are {}", scene, scenes.size()));
      return indices_in(scenes[scene], "nodes");
    }
    std::vector<bool> is_child(list("nodes").size());
    for (const Json& node : list("nodes"))
      for (const std::size_t child : indices_in(node, "children"))
        if (child < is_child.size()) is_child[child] = true;
    for (std::size_t node = 0; node < is_child.size(); ++node)
      if (!is_child[node]) all.push_back(node);
    return all;
  }

  [[nodiscard]] std::vector<std::size_t> indices_in(const Json& from, const char* key) const {
    std::vector<std::size_t> all;
    const auto found = from.find(key);
    if (found == from.end()) return all;
    for (const Json& one : *found) {
      if (!one.is_number_unsigned()) fail(fmt::format("{} has no whole numbers alone", key));
      all.push_back(one.get<std::size_t>());
    }
    return all;
  }

  [[nodiscard]] std::vector<double> numbers_in(const Json& from, const char* key, std::size_t count) const {
    std::vector<double> all;
    const auto found = from.find(key);
    if (found == from.end()) return all;
    for (const Json& one : *found) {
      if (!one.is_number()) fail(fmt::format("{} has no numbers alone", key));
      all.push_back(one.get<double>());
    }
    if (all.size() != count) fail(fmt::format("{} needs {} numbers (got {})", key, count, all.size()));
    return all;
  }

  [[nodiscard]] glm::dmat4 matrix_of(const Json& node) const {
    glm::dmat4 matrix(1.0);
    if (const auto m = numbers_in(node, "matrix", 16); !m.empty()) {
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
      return matrix;
    }
    if (const auto q = numbers_in(node, "rotation", 4); !q.empty()) {
      const double x = q[0];
      const double y = q[1];
      const double z = q[2];
      const double w = q[3];
      matrix[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
      matrix[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
      matrix[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
    }
    if (const auto s = numbers_in(node, "scale", 3); !s.empty())
      for (int axis = 0; axis < 3; ++axis) matrix[axis] *= s[static_cast<std::size_t>(axis)];
    if (const auto t = numbers_in(node, "translation", 3); !t.empty()) matrix[3] = {t[0], t[1], t[2], 1};
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
      const Json& nodes = list("nodes");
      if (number >= nodes.size() || !nodes[number].is_object())
        fail(fmt::format("node {} is not there: there are {}", number, nodes.size()));
      if (visited_[number]) fail(fmt::format("node {} is in two places, or contains itself", number));
      visited_[number] = true;
      const Json& node = nodes[number];
      const glm::dmat4 matrix = parent * matrix_of(node);
      if (node.contains("skin")) ++left_out_["skins"];
      if (const Json* mesh = referred(node, "mesh", "meshes")) add_mesh(*mesh, matrix, group_set(node, *mesh));
      std::vector<std::size_t> children = indices_in(node, "children");
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
    if (primitives == mesh.end() || !primitives->is_array()) fail("a mesh has no primitives");
    for (const Json& one : *primitives) {
      if (!one.is_object()) fail("a primitive is no object");
      add_primitive(one, matrix, set);
    }
  }

  void add_primitive(const Json& primitive, const glm::dmat4& matrix, std::uint32_t set) {
    enum Mode : std::size_t { triangles = 4, strip, fan };
    const std::size_t mode = whole(primitive, "mode").value_or(triangles);
    if (mode < triangles || mode > fan) {
      ++left_out_["points and lines"];
      return;
    }
    if (primitive.contains("targets")) ++left_out_["morph targets"];
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) fail("a primitive has no attributes");
    const std::optional<Rows> positions = rows(*attributes, "POSITION", 3);
    if (!positions) return;
    const std::optional<Rows> normals = rows(*attributes, "NORMAL", 3);
    const std::size_t base = mesh_.positions.size();
    if (base + positions->count > UINT32_MAX) fail("has more vertices than 2^32");
    add_vertices(*positions, normals, matrix);
    const std::optional<Rows> indices = rows(primitive, "indices", 1);
    const std::size_t count = indices ? indices->count : positions->count;
    const auto corner = [&](std::size_t i) {
      const double index = indices ? indices->at(i, 0) : static_cast<double>(i);
      if (!(index < static_cast<double>(positions->count)))
        fail(fmt::format("index {} is out of range: a primitive has {} vertices", index, positions->count));
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
    (void)referred(primitive, "material", "materials");
    const auto material = whole(primitive, "material").value_or(no_material);
    of_triangle_.emplace_back(mesh_.triangles.size(), material);
    mesh_.groups.of_triangle.resize(mesh_.triangles.size(), set);
  }

  void add_vertices(const Rows& positions, const std::optional<Rows>& normals, const glm::dmat4& matrix) {
    if (normals && normals->count != positions.count) fail("a primitive has not as many normals as positions");
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

  /// The numbers of an accessor that `from` refers to.
  [[nodiscard]] std::optional<Rows> rows(const Json& from, const char* key, std::size_t components) const {
    const Json* accessor = referred(from, key, "accessors");
    if (accessor == nullptr) return std::nullopt;
    if (accessor->contains("sparse")) fail("has sparse accessors, which are not read");
    const Json* view = referred(*accessor, "bufferView", "bufferViews");
    if (view == nullptr) fail(fmt::format("the accessor of {} has no bufferView", key));
    const auto buffer = whole(*view, "buffer");
    if (!buffer || *buffer >= buffers_.size()) fail("a bufferView has no buffer that is there");
    static const std::map<std::size_t, std::pair<NumberType, double>> types{{5120, {NumberType::int8, 127}},
                                                                            {5121, {NumberType::uint8, 255}},
                                                                            {5122, {NumberType::int16, 32767}},
                                                                            {5123, {NumberType::uint16, 65535}},
                                                                            {5125, {NumberType::uint32, 4294967295.0}},
                                                                            {5126, {NumberType::float32, 1}}};
    const auto type = types.find(whole(*accessor, "componentType").value_or(0));
    static const std::map<std::string, std::size_t> shapes{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    const auto shape =
        shapes.find(accessor->value("type", Json()).is_string() ? (*accessor)["type"].get<std::string>() : "");
    if (type == types.end() || shape == shapes.end() || shape->second != components)
      fail(fmt::format("the accessor of {} has another type than {} numbers", key, components));
    const NumberType number = type->second.first;
    const bool unsigned_whole =
        number == NumberType::uint8 || number == NumberType::uint16 || number == NumberType::uint32;
    if (components == 1 && !unsigned_whole) fail("indices are no whole numbers from 0 on");
    Rows found{.count = whole(*accessor, "count").value_or(0), .components = components, .type = type->second.first};
    if (components > 1 && accessor->value("normalized", Json()) == true) found.divisor = type->second.second;
    const std::size_t size = components * size_of(found.type);
    found.stride = whole(*view, "byteStride").value_or(size);
    const std::string& bytes = buffers_[*buffer];
    const std::size_t begin = whole(*view, "byteOffset").value_or(0);
    const std::size_t length = whole(*view, "byteLength").value_or(0);
    const std::size_t offset = whole(*accessor, "byteOffset").value_or(0);
    if (begin > bytes.size() || length > bytes.size() - begin) fail("a bufferView ends beyond its buffer");
    const bool fits = found.count == 0 || (offset <= length && size <= length - offset && found.stride >= size &&
                                           (found.count - 1) <= (length - offset - size) / found.stride);
    if (!fits) fail(fmt::format("the accessor of {} ends beyond its bufferView", key));
    found.first = bytes.data() + begin + offset;
    return found;
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
    if (materials.all.size() > no_back) fail(fmt::format("has {} materials, which are too many", materials.all.size()));
    for (const auto& [end, material] : of_triangle_)
      materials.of_triangle.resize(end, static_cast<std::uint16_t>(material == no_material ? matt_one : material));
  }

  void note(Notices& notices) {
    for (const auto& [name, what] : std::array<std::pair<const char*, const char*>, 3>{
             {{"cameras", "cameras"}, {"animations", "animations"}, {"textures", "textures"}}})
      if (!list(name).empty()) left_out_[what] += list(name).size();
    if (const auto extensions = text_.json.find("extensions");
        extensions != text_.json.end() && extensions->contains("KHR_lights_punctual"))
      ++left_out_["lights (KHR_lights_punctual)"];
    for (const auto& [what, count] : left_out_)
      notices.push_back(fmt::format("{}: {}, left out: {}", shown_path(path_), what, count));
  }

  static constexpr std::size_t no_material = SIZE_MAX;

  const std::string& path_;
  std::stop_token stop_;
  GltfText text_;
  KeptMemory memory_;
  StopCheck check_;
  std::vector<std::string> buffers_;
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
  std::vector<std::string> paths;
  const GltfText text = read_text(path, std::move(stop));
  const auto buffers = text.json.find("buffers");
  if (buffers == text.json.end() || !buffers->is_array()) return paths;
  for (const Json& one : *buffers)
    if (const auto uri = one.find("uri"); one.is_object() && uri != one.end() && uri->is_string())
      if (const auto name = uri->get<std::string>(); !is_data(name))
        paths.push_back(beside(path, without_percents(name)));
  return paths;
}

}  // namespace detp::sim
