#include "detp/sim/scene/mesh.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/scene/scene.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// A corner of a cube with side `side`: three faces, of 1, 1 and 2 triangles, meet at vertex 0.
Mesh cube_corner(double side) {
  return {.positions = {{0, 0, 0}, {side, 0, 0}, {0, side, 0}, {0, 0, side}, {side, side, 0}},
          .normals = {},
          .triangles = {{0, 4, 1}, {0, 2, 4}, {0, 3, 2}, {0, 1, 3}}};
}

std::vector<Sample> samples_of(const Mesh& mesh) {
  Notices notices;
  return samples_at_vertices(mesh, notices);
}

bool is_close(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-14; }

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a vertex normal is the mean over the adjacent triangles, weighted by area, at any scale") {
    for (const double side : {1.0, 3e-13, 7e12, 1e-160, 1e160, 1e-300, 1e300}) {
      CAPTURE(side);
      const auto samples = samples_of(cube_corner(side));
      REQUIRE(samples.size() == 5);
      CHECK(is_close(samples[0].normal, glm::normalize(glm::dvec3{-1, -1, -2})));
      CHECK(is_close(samples[1].normal, glm::normalize(glm::dvec3{0, -1, -1})));
      CHECK(is_close(samples[4].normal, {0, 0, -1}));
      CHECK(samples[4].position == glm::dvec3{side, side, 0});
    }
  }

  TEST_CASE("the mesh's own normals are used, scaled to length 1, and those of the triangles in place of zero") {
    Mesh mesh = cube_corner(1);
    mesh.normals = {{0, 0, 3}, {1e-300, 0, 0}, {0, 1e300, 0}, {0, 0, 0}, {1, 1, 0}};
    Notices notices;
    const auto samples = samples_at_vertices(mesh, notices);
    REQUIRE(samples.size() == 5);
    CHECK(samples[0].normal == glm::dvec3{0, 0, 1});
    CHECK(samples[1].normal == glm::dvec3{1, 0, 0});
    CHECK(samples[2].normal == glm::dvec3{0, 1, 0});
    CHECK(samples[3].normal == samples_of(cube_corner(1))[3].normal);  // in place of zero
    CHECK(notices.empty());
  }

  TEST_CASE("unreferenced vertices and those whose triangles have no area are dropped, with a count of each kind") {
    Mesh mesh = cube_corner(1);
    const double third = 1.0 / 3;
    for (const glm::dvec3& position :
         {glm::dvec3{9}, glm::dvec3{9}, {5, 5, 5}, {5 + third, 5 + third, 5 + third}, {6, 6, 6}})
      mesh.positions.push_back(position);
    mesh.triangles.push_back({7, 8, 9});  // collinear within rounding
    mesh.triangles.push_back({7, 7, 7});
    Notices notices;
    CHECK(samples_at_vertices(mesh, notices).size() == 5);
    CHECK(notices == Notices{"2 unreferenced vertices dropped", "3 vertices dropped: no triangle around has an area"});
  }

  TEST_CASE("a leaf with one triangle for each face keeps the normal of its first triangle") {
    const Mesh leaf{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}, {0, 2, 1}}};
    const auto samples = samples_of(leaf);
    REQUIRE(samples.size() == 3);
    for (const Sample& sample : samples) CHECK(sample.normal == glm::dvec3{0, 0, 1});
  }

  TEST_CASE("the normal of a needle 1e7 times as long as wide is right to 1e-8") {
    const Mesh needle{.positions = {{0.1, 0.2, 0.3}, {1.1, 0.2, 0.3}, {0.6, 0.2 + 1e-7, 0.3}},
                      .normals = {},
                      .triangles = {{0, 1, 2}}};
    CHECK(glm::length(samples_of(needle)[0].normal - glm::dvec3{0, 0, 1}) < 1e-8);
  }

  TEST_CASE("the mean edge counts each edge once, and no edge of length zero") {
    CHECK(mean_edge_length({}) == 0);
    const double diagonal = std::sqrt(2.0);
    // 5 edges are sides along the axes, 3 are diagonals of the faces.
    CHECK(mean_edge_length(cube_corner(1)) == doctest::Approx((5 + 3 * diagonal) / 8).epsilon(1e-14));
    CHECK(mean_edge_length(cube_corner(1e-200)) == doctest::Approx(1e-200 * (5 + 3 * diagonal) / 8).epsilon(1e-14));
    Mesh degenerate = cube_corner(1);
    degenerate.positions.push_back(degenerate.positions[0]);
    degenerate.triangles.push_back({0, 0, 1});
    degenerate.triangles.push_back({0, 5, 0});
    CHECK(mean_edge_length(degenerate) == doctest::Approx((5 + 3 * diagonal) / 8).epsilon(1e-14));
  }

  TEST_CASE("the mean edges of test scenes without double vertices agree with their table" *
            doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    for (const auto& [bound_name, mean_over_diagonal] : {std::pair<const char*, double>{"stanford_bunny.obj", 0.005999},
                                                         {"stanford_dragon.ply", 0.007978},
                                                         {"sponza.ply", 0.004963},
                                                         {"mountain.obj", 0.005661},
                                                         {"tangerine_fine.ply", 0.005719},
                                                         {"grove_fine.ply", 0.005271},
                                                         {"pathological/huge_offset.obj", 0.03316},
                                                         {"pathological/huge_scale.obj", 0.03316},
                                                         {"pathological/tiny_scale.obj", 0.03316}}) {
      const auto& name = bound_name;
      CAPTURE(name);
      Notices notices;
      const Mesh mesh = read_mesh(folder + "/" + name, notices);
      Box box;
      for (const glm::dvec3& position : mesh.positions) box.include(position);
      CHECK(mean_edge_length(mesh) / glm::length(box.size()) == doctest::Approx(mean_over_diagonal).epsilon(2e-4));
    }
  }

  TEST_CASE("a mesh gives the same normals at 1e-12, 1 and 1e12 times its size" * doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    Notices notices;
    const auto tiny = samples_of(read_mesh(folder + "/pathological/tiny_scale.obj", notices));
    const auto huge = samples_of(read_mesh(folder + "/pathological/huge_scale.obj", notices));
    REQUIRE(tiny.size() == 829);
    REQUIRE(huge.size() == 829);
    double largest = 0;
    for (std::size_t i = 0; i < tiny.size(); ++i)
      largest = std::max(largest, glm::length(tiny[i].normal - huge[i].normal));
    CHECK(largest < 1e-4);  // the files have about 6 digits
    CHECK(largest > 0);
  }
}
