#include "detp/sim/scene/selection.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <set>
#include <stdexcept>
#include <string>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/scene/families/families.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;

namespace support = detp::support;

namespace {

/// A floor with tiles beside it, and a wall that meets the floor at a right angle. No library defines the tiles.
Scene floor_and_wall(std::optional<std::size_t> samples = {}) {
  const support::ScratchFolder folder;
  folder.file("m.mtl", "newmtl floor\nKd 0.4\nnewmtl wall\nKd 0.6\n");
  const std::string file = folder.file("m.obj",
                                       "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 2 0 0\n"
                                       "v 2 1 0\ng ground\nusemtl floor\nf 1 2 3 4\nusemtl tiles\nf 2 7 8 3\n"
                                       "g house north\nusemtl wall\nf 1 5 6 2\n");
  return open_scene({.name = file, .samples = samples});
}

bool on_floor(const Sample& sample) { return sample.normal.z > 0.5 && sample.position.x <= 1; }
bool on_tiles(const Sample& sample) { return sample.normal.z > 0.5 && sample.position.x >= 1; }
bool on_wall(const Sample& sample) { return sample.normal.y > 0.5; }

std::vector<std::size_t> samples_where(const Scene& scene, const std::function<bool(const Sample&)>& is_one) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < scene.samples.size(); ++i)
    if (is_one(scene.samples[i])) indices.push_back(i);
  return indices;
}

std::string refusal(const Mesh& mesh, const FaceNames& names) {
  try {
    (void)triangles_named(mesh, names);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("samples at vertices and by area are on the faces with a material; at an edge within a plane, on both") {
    for (const std::size_t count : {std::size_t{10}, std::size_t{3000}}) {
      CAPTURE(count);
      const Scene scene = floor_and_wall(count);
      const auto named = [&](const FaceNames& names) { return samples_named(scene.mesh, scene.samples, names); };
      CHECK(named({.materials = {"floor"}}) == samples_where(scene, on_floor));
      CHECK(named({.materials = {"tiles"}}) == samples_where(scene, on_tiles));
      CHECK(named({.materials = {"wall"}}) == samples_where(scene, on_wall));
      CHECK(named({.groups = {"ground"}}) == samples_where(scene, [](const Sample& one) { return !on_wall(one); }));
      CHECK(named({.groups = {"north", "ground"}}).size() == count);
      CHECK(named({.materials = {"wall", "tiles"}, .groups = {"ground"}}) == samples_where(scene, on_tiles));
    }
    CHECK(samples_where(floor_and_wall(10), on_floor).size() == 4);
    CHECK(samples_where(floor_and_wall(10), on_wall).size() == 4);
  }

  TEST_CASE("points that are no samples of the scene lie on the nearest faces that they face") {
    const Scene scene = floor_and_wall();
    const auto is_on = [&](const char* material, const glm::dvec3& position, const glm::dvec3& normal) {
      const Sample sample{.position = position, .normal = glm::normalize(normal)};
      const Sample other = scene.samples[samples_named(scene.mesh, scene.samples, {.materials = {material}}).front()];
      return samples_named(scene.mesh, std::array{other, sample}, {.materials = {material}}).size() == 2;
    };
    CHECK(is_on("floor", {0.5, 0.5, 0}, {0, 0, 1}));
    CHECK(is_on("floor", {0.5, 0.5, 2e-6}, {0, 1, 1}));
    CHECK_FALSE(is_on("tiles", {0.5, 0.5, 0}, {0, 0, 1}));
    CHECK_FALSE(is_on("floor", {0.5, 0.5, 1e-5}, {0, 0, 1}));
    CHECK_FALSE(is_on("floor", {0.5, 0.5, 0}, {0, 0, -1}));
    CHECK_FALSE(is_on("floor", {0.5, 0.5, 0}, {0, 2, 1}));
    CHECK_FALSE(is_on("floor", {1 + 1e-7, 0.5, 0}, {0, 0, 1}));
    for (const char* both : {"floor", "tiles"}) CHECK(is_on(both, {1, 0.5, 0}, {0, 0, 1}));
    for (const char* both : {"floor", "wall"}) CHECK(is_on(both, {0, 0, 0}, {0, 1, 1}));
  }

  TEST_CASE("a face has the material of its front, and that of its back if it is another one") {
    const Mesh mesh{.positions = {{}, {}, {}},
                    .normals = {},
                    .triangles = {{0, 1, 2}, {0, 1, 2}},
                    .materials = {.all = {{.name = "front"}, {.name = "back"}}, .of_back = {1, no_back}}};
    CHECK(triangles_named(mesh, {.materials = {"front"}}) == std::vector<bool>{true, true});
    CHECK(triangles_named(mesh, {.materials = {"back"}}) == std::vector<bool>{true, false});
    CHECK(triangles_named(mesh, {}) == std::vector<bool>{true, true});
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("unknown names are refused with the known ones, and names on which no sample lies") {
    const Scene scene = floor_and_wall();
    CHECK(refusal(scene.mesh, {.materials = {"floor", "wal"}}) ==
          "there is no material \"wal\"; known materials are floor, tiles, wall; did you mean wall?");
    CHECK(refusal(scene.mesh, {.groups = {"floor"}}) ==
          "there is no group \"floor\"; known groups are ground, house, north");
    CHECK(refusal(scene.mesh, {.materials = {""}}).starts_with("there is no material \"\""));
    CHECK(refusal({}, {.materials = {"a"}}) == "there is no material \"a\": the mesh has no materials");
    CHECK(refusal({}, {.groups = {"\x1b"}}) == "there is no group \"\\x1b\": the mesh has no groups");
    CHECK_THROWS_WITH_AS((void)samples_named(scene.mesh, scene.samples, {.materials = {"wall"}, .groups = {"ground"}}),
                         "no sample lies on the named faces, which are 0 triangles", std::invalid_argument);
    Mesh many;
    for (int i = 0; i < 12; ++i) many.groups.names.push_back(std::to_string(100 + i));
    CHECK(refusal(many, {.groups = {"x"}}) ==
          "there is no group \"x\"; known groups are 100, 101, 102, 103, 104, 105, 106, 107, 108, 109 and 2 more");
    many.triangles.resize(1);
    CHECK(refusal(many, {.groups = {"100"}}) == "each triangle needs a set of groups (0 for 1 triangles)");
  }

  TEST_CASE("a stop request ends the search for samples") {
    const Scene scene = floor_and_wall();
    std::stop_source stop;
    stop.request_stop();
    const std::vector<Sample> many(100'000, Sample{.position = {0.5, 0.5, 0}});
    CHECK_THROWS_AS((void)samples_named(scene.mesh, many, {.materials = {"floor"}}, stop.get_token()), Stopped);
  }
}

namespace detp::sim {
namespace {

Scene open_family(std::string_view family, const std::string& seed) {
  return open_scene({.name = "@" + std::string(family) + ":" + seed, .samples = {}});
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("each family has another scene for each seed, with samples and light" * doctest::test_suite("long")) {
    for (const families::Family& family : families::all_families) {
      CAPTURE(family.name);
      std::set<std::size_t> counts;
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Scene scene = open_family(family.name, std::to_string(seed));
        CHECK(scene.samples.size() >= 1000);
        CHECK(scene.samples.size() <= 200'000);
        CHECK_FALSE(scene.lights.empty());
        CHECK_NOTHROW(check(scene.mesh.materials, scene.mesh.triangles.size()));
        CHECK(scene.mesh.positions == open_family(family.name, std::to_string(seed)).mesh.positions);
        counts.insert(scene.samples.size());
      }
      CHECK(counts.size() == 4);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a family needs a whole number as seed") {
    for (const char* seed : {"", "x", "-1", "1.5", "1x", "99999999999999999999999"})
      CHECK_THROWS_AS(static_cast<void>(open_family("room", seed)), std::invalid_argument);
    CHECK_THROWS_AS(static_cast<void>(open_scene({.name = "@room", .samples = {}})), std::invalid_argument);
  }
}

}  // namespace detp::sim
