#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <set>

#include "detp/sim/files/gltf_file.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/validate/picture/bitmap.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using detp::support::content_of;
using detp::support::file_error_of;
using detp::support::ScratchFolder;

namespace {

template <class Number>
std::string raw_bytes(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// A square of two triangles at z = 0, in floats, then its indices, then those of a strip.
std::string square_buffer() {
  return raw_bytes<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + raw_bytes<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
         raw_bytes<std::uint16_t>({0, 1, 3, 2});
}

/// The square with these nodes, and a primitive with more members.
std::string square_gltf(const std::string& nodes, const std::string& primitive = R"("indices": 1)",
                        const std::string& more = "") {
  return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [)" + nodes +
         R"(], "meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0}, )" + primitive +
         R"(}]}], "accessors": [
{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
{"bufferView": 2, "componentType": 5123, "count": 4, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12},
{"buffer": 0, "byteOffset": 60, "byteLength": 8}], )" +
         more + R"("buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,)" +
         detp::validate::base64(square_buffer()) + R"("}]})";
}

Mesh mesh_in(const std::string& path) {
  Notices notices;
  return read_mesh(path, notices);
}

/// The places of the corners of each triangle.
std::vector<std::array<glm::dvec3, 3>> corners_of(const Mesh& mesh) {
  std::vector<std::array<glm::dvec3, 3>> all;
  for (const auto& [a, b, c] : mesh.triangles) all.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  return all;
}

glm::dvec3 normal_of(const Mesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = corners_of(mesh).at(triangle);
  return glm::normalize(glm::cross(b - a, c - a));
}

std::string stl_of(const Mesh& mesh, bool binary) {
  std::string text = binary ? std::string("solid, says the head of many programs") : "solid part one\n";
  if (binary) {
    text.resize(80, ' ');
    text += raw_bytes<std::uint32_t>({static_cast<std::uint32_t>(mesh.triangles.size())});
  }
  for (const auto& triangle : corners_of(mesh)) {
    std::vector<float> numbers{0, 0, 0};
    if (!binary) text += "facet normal 0 0 0\n outer loop\n";
    for (const glm::dvec3& corner : triangle) {
      for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<float>(corner[axis]));
      if (!binary) text += fmt::format("  vertex {:e} {:e} {:e}\r\n", corner.x, corner.y, corner.z);
    }
    text += binary ? raw_bytes(numbers) + std::string(2, '\0') : " endloop\nendfacet\n";
  }
  return binary ? text : text + "endsolid part one\n";
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("STL, text and binary, is the scene that the same OBJ is") {
    const ScratchFolder folder;
    const std::string obj = folder.file(
        "a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 4 3\nf 1 2 5\nf 1 5 4\nf 2 3 5\nf 3 4 5\n");
    const Mesh mesh = mesh_in(obj);
    const Scene scene = open_scene({.name = obj, .samples = {}});
    for (const bool binary : {false, true}) {
      const std::string stl = folder.file("a.STL", stl_of(mesh, binary));
      CHECK(corners_of(mesh_in(stl)) == corners_of(mesh));
      const Scene other = open_scene({.name = stl, .samples = {}});
      REQUIRE(other.samples.size() == scene.samples.size());
      std::set<std::array<double, 6>> here;
      std::set<std::array<double, 6>> there;
      for (std::size_t i = 0; i < scene.samples.size(); ++i) {
        const auto rounded = [](double x) { return std::round(x * 1e9) + 0.0; };
        const auto key = [&](const Sample& one) {
          return std::array{rounded(one.position.x), rounded(one.position.y), rounded(one.position.z),
                            rounded(one.normal.x),   rounded(one.normal.y),   rounded(one.normal.z)};
        };
        here.insert(key(scene.samples[i]));
        there.insert(key(other.samples[i]));
      }
      CHECK(here == there);
      if (!binary) CHECK(mesh_in(stl).groups.names == std::vector<std::string>{"part one"});
    }
  }

  TEST_CASE("the solids of a text STL are groups, also after triangles without a name") {
    const ScratchFolder folder;
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const Mesh mesh = mesh_in(
        folder.file("a.stl", "solid\n" + facet + "endsolid\nsolid lid\n" + facet + "endsolid\nsolid rim\n" + facet));
    REQUIRE(mesh.triangles.size() == 3);
    CHECK(mesh.groups.names == std::vector<std::string>{"lid", "rim"});
    CHECK(mesh.groups.sets[mesh.groups.of_triangle[0]].empty());
    CHECK(mesh.groups.sets[mesh.groups.of_triangle[1]] == std::vector<std::uint32_t>{0});
    CHECK(mesh.groups.sets[mesh.groups.of_triangle[2]] == std::vector<std::uint32_t>{1});
  }

  TEST_CASE(
      "a glTF node has its mesh where its matrix puts it; a mirror turns the triangles, and normals stay outside") {
    const ScratchFolder folder;
    const Mesh plain = mesh_in(folder.file("a.gltf", square_gltf(R"({"mesh": 0, "name": "floor"})")));
    CHECK(plain.groups.names == std::vector<std::string>{"floor", "square"});
    CHECK(normal_of(plain, 0) == glm::dvec3{0, 0, 1});
    // A child of a parent: scaled by 2, turned by 90 degrees about x, moved; and mirrored in x.
    const Mesh moved = mesh_in(folder.file("b.gltf", square_gltf(R"({"children": [1, 2], "translation": [10, 0, 0]},
{"mesh": 0, "scale": [2, 2, 2], "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476]}, {"mesh": 0, "scale": [-1, 1, 1]})")));
    REQUIRE(moved.triangles.size() == 4);
    CHECK(glm::distance(corners_of(moved)[0][2], {12, 0, 2}) < 1e-12);
    CHECK(glm::distance(normal_of(moved, 0), {0, -1, 0}) < 1e-12);
    CHECK(glm::distance(normal_of(moved, 2), {0, 0, 1}) < 1e-12);
    // A matrix, by columns.
    const Mesh by_matrix = mesh_in(folder.file(
        "c.gltf", square_gltf(R"({"mesh": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]})")));
    CHECK(corners_of(by_matrix)[0][1] == glm::dvec3{5, 7, 7});
  }

  TEST_CASE("strips and fans are triangles that all face as the first one") {
    const ScratchFolder folder;
    for (const char* primitive : {R"("indices": 2, "mode": 5)", R"("mode": 6)"}) {
      const Mesh mesh = mesh_in(folder.file("a.gltf", square_gltf(R"({"mesh": 0})", primitive)));
      REQUIRE(mesh.triangles.size() == 2);
      for (std::size_t i = 0; i < 2; ++i) CHECK(normal_of(mesh, i) == glm::dvec3{0, 0, 1});
    }
  }

  TEST_CASE("materials: metal, gloss, glass, emission, and those that are none") {
    const ScratchFolder folder;
    const auto material = [&](const std::string& of) {
      const Mesh mesh = mesh_in(folder.file(
          "a.gltf", square_gltf(R"({"mesh": 0})", R"("indices": 1, "material": 0)", R"("materials": [)" + of + "], ")));
      REQUIRE(mesh.materials.all.size() == 1);
      REQUIRE(mesh.materials.of_triangle.size() == 2);
      check(mesh.materials, 2);
      return mesh.materials.all[0];
    };
    const Material matt = material(
        R"({"name": "clay", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}})");
    CHECK(matt.name == "clay");
    CHECK(matt.diffuse == doctest::Approx(0.5 * 0.96));
    CHECK(matt.specular == doctest::Approx(0.04));
    CHECK(matt.shininess == 1);
    CHECK_FALSE(matt.colours);
    const Material mirror =
        material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.1, 1], "roughnessFactor": 0}})");
    CHECK(mirror.diffuse == 0);
    CHECK(std::isinf(mirror.shininess));
    REQUIRE(mirror.colours);
    CHECK(mirror.colours->specular == glm::dvec3{0.9, 0.8, 0.1});
    const Material glass = material(
        R"({"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
"KHR_materials_ior": {"ior": 1.33}}})");
    CHECK(glass.glass == 1);
    CHECK(glass.index == 1.33);
    CHECK(glass.diffuse == 0);
    const Material lamp = material(R"({"emissiveFactor": [1, 1, 1], "pbrMetallicRoughness": {"metallicFactor": 0},
"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 25}}})");
    CHECK(lamp.emitted == 25);
    CHECK(lamp.diffuse + lamp.specular == doctest::Approx(0.98));
    const Material textured =
        material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}})");
    CHECK(textured.diffuse == doctest::Approx(0.48));
    CHECK(mesh_in(folder.file("n.gltf", square_gltf(R"({"mesh": 0})"))).materials.all.empty());
  }

  TEST_CASE("a .glb, and a .gltf with its buffer beside it, are the same mesh; what is left out is said") {
    const ScratchFolder folder;
    std::string json = square_gltf(R"({"mesh": 0})", R"("indices": 1)", R"("cameras": [{}], "textures": [{}, {}], )");
    const Mesh whole = mesh_in(folder.file("a.gltf", json));
    const std::size_t uri = json.find(R"(, "uri")");
    std::string beside = json.substr(0, uri) + R"(, "uri": "my%20square.bin"}]})";
    (void)folder.file("my square.bin", square_buffer());
    const std::string path = folder.file("b.gltf", beside);
    Notices notices;
    CHECK(corners_of(read_mesh(path, notices)) == corners_of(whole));
    CHECK(notices.size() == 2);
    CHECK(notices.front().find("cameras, left out: 1") != std::string::npos);
    CHECK(files_of_mesh(path) == std::vector<std::string>{folder.path("my square.bin")});
    std::string inside = json.substr(0, uri) + "}]}";
    inside.resize((inside.size() + 3) / 4 * 4, ' ');
    const std::string binary = square_buffer();
    const auto size = [](std::size_t bytes) { return raw_bytes<std::uint32_t>({static_cast<std::uint32_t>(bytes)}); };
    const std::string glb = "glTF" + size(2) + size(28 + inside.size() + binary.size()) + size(inside.size()) + "JSON" +
                            inside + size(binary.size()) + std::string("BIN\0", 4) + binary;
    CHECK(corners_of(mesh_in(folder.file("c.glb", glb))) == corners_of(whole));
    CHECK(file_error_of([&] {
            (void)mesh_in(folder.file("d.glb", glb.substr(0, glb.size() - 1)));
          }).find("ends early") != std::string::npos);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("STL that ends early, or is something else") {
    const ScratchFolder folder;
    const auto refusal = [&](const std::string& text) {
      return file_error_of([&] { (void)mesh_in(folder.file("a.stl", text)); });
    };
    CHECK(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n").find(":4: \"x\" is not a number") !=
          std::string::npos);
    CHECK(refusal("solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nendloop\n").find("three corners (got 2)") !=
          std::string::npos);
    CHECK(refusal("solid a\nfacet\nouter loop\nvertex 0 0 0\n").find("ends within a facet") != std::string::npos);
    CHECK(refusal("solid a\nv 0 0 0\n").find("is no word of STL") != std::string::npos);
    CHECK(refusal("solid a\nendsolid a\n").find("has no faces") != std::string::npos);
    CHECK(refusal(std::string(80, 'x') + raw_bytes<std::uint32_t>({2}) + std::string(50, '\0')).find("ends early") !=
          std::string::npos);
    CHECK(refusal("solid a\nfacet\nouter loop\nvertex nan 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\n")
              .find("not finite") != std::string::npos);
  }

  TEST_CASE("glTF with references that lead nowhere, buffers that are too short, and what is not read") {
    const ScratchFolder folder;
    const std::string good = square_gltf(R"({"mesh": 0})");
    const auto refusal = [&](const std::string& from, const std::string& to) {
      std::string text = good;
      const std::size_t at = text.find(from);
      REQUIRE(at != std::string::npos);
      text.replace(at, from.size(), to);
      return file_error_of([&] { (void)mesh_in(folder.file("a.gltf", text)); });
    };
    const std::array<std::array<const char*, 3>, 17> cases{{
        {R"("version": "2.0")", R"("version": "1.0")", "version 2.x is read"},
        {R"({"asset")", R"(["asset")", "is no glTF"},
        {R"("mesh": 0)", R"("mesh": 1)", "meshes 1 is not there: there are 1"},
        {R"("mesh": 0)", R"("mesh": -1)", "mesh is no whole number"},
        {R"("mesh": 0)", R"("mesh": 0, "children": [0])", "contains itself"},
        {R"("mesh": 0)", R"("mesh": 0, "scale": [1, 1])", "scale needs 3 numbers"},
        {R"("nodes": [0])", R"("nodes": [4])", "node 4 is not there"},
        {R"("indices": 1)", R"("indices": 0)", "another type"},
        {R"("indices": 1)", R"("indices": 9)", "accessors 9 is not there"},
        {R"("byteLength": 48})", R"("byteLength": 47})", "ends beyond its bufferView"},
        {R"("byteOffset": 48, "byteLength": 12)", R"("byteOffset": 60, "byteLength": 12)", "ends beyond its buffer"},
        {R"("byteLength": 68)", R"("byteLength": 69)", "buffer 0 has 68 bytes; 69 are needed"},
        {";base64,", ",", "not in base64"},
        {R"("count": 6)", R"("count": 18446744073709551615)", "ends beyond its bufferView"},
        {R"("componentType": 5123, "count": 6)", R"("componentType": 5120, "count": 6)", "from 0 on"},
        {R"("count": 6, "type": "SCALAR")", R"("count": 6, "type": "SCALAR", "sparse": {})", "sparse"},
        {R"("scenes")", R"("extensionsRequired": ["KHR_draco_mesh_compression"], "scenes")", "export it without"},
    }};
    for (const auto& one : cases) {
      const std::string message = refusal(one[0], one[1]);
      CHECK_MESSAGE(message.find(one[2]) != std::string::npos, message, one[2]);
    }
    CHECK(file_error_of([&] {
            (void)mesh_in(folder.file("a.gltf", square_gltf(R"({"mesh": 0})", R"("mode": 1)")));
          }).find("has no faces") != std::string::npos);
  }
}
