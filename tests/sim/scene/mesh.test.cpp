#include "detp/sim/scene/mesh.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/scene/vertices.hpp"
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

std::vector<Sample> samples_of(Mesh mesh) {
  Notices notices;
  return samples_at_vertices(mesh, 180, notices);
}

}  // namespace

TEST_SUITE("known answer") {
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
