#include "detp/sim/scene/mesh.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/scene/facet.hpp"
#include "detp/sim/scene/scene.hpp"
#include "detp/sim/scene/up.hpp"
#include "detp/sim/scene/vertices.hpp"
#include "support/boxes.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using detp::support::box_of;

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

Up up_when_turned(Mesh mesh, const Up& to) {
  for (glm::dvec3& position : mesh.positions) position = to.from_y(position);
  return up_of(mesh, box_of(mesh));
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

  TEST_CASE("trees and courtyard: up is found whichever way they are turned" * doctest::test_suite("long")) {
    for (const char* scene : {"@tree", "@tree-coarse", "@courtyard"}) {
      const Mesh mesh = open_scene({.name = scene, .samples = {}}).mesh;
      for (const auto& [name_of_up, up] : named_ups) {
        const std::string_view known = name_of_up;  // clang 14 cannot capture a binding
        INFO("scene ", scene, ", known ", known);
        CHECK(up_when_turned(mesh, up) == up);
      }
    }
  }

  TEST_CASE("an open box, whose shape does not tell, and a single triangle are taken as Y up") {
    CHECK(up_of(open_scene({.name = "@cornell", .samples = {}}).mesh, {glm::dvec3{0.0}, glm::dvec3{1.0}}) == Up{});
    Mesh triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    triangle.triangles = {{0, 1, 2}};
    CHECK(up_of(triangle, box_of(triangle)) == Up{});
  }

  TEST_CASE("of the meshes, the tangerine tree stands along Z, the rest along Y" * doctest::test_suite("scenes")) {
    const std::string folder = detp::support::scenes_folder();
    if (folder.empty()) return;
    for (const char* file : {"tangerine_fine.ply", "tangerine_coarse.ply"})
      CHECK(open_scene({.name = folder + "/" + file, .samples = {}}).up == Up{2, 1});
    for (const char* file : {"stanford_bunny.obj", "sponza.ply", "mountain.obj", "grove_fine.ply", "grove_coarse.ply",
                             "cornell_box.obj", "tree.obj", "bedroom.ply", "stanford_dragon.ply"}) {
      CAPTURE(file);
      CHECK(open_scene({.name = folder + "/" + file, .samples = {}}).up == Up{});
    }
  }
}

TEST_SUITE("identity") {
  TEST_CASE("turning to Y takes up to (0, 1, 0), keeps hands, and turning back undoes it exactly") {
    for (const auto& [name_of_up, up] : named_ups) {
      const std::string_view known = name_of_up;  // clang 14 cannot capture a binding
      CAPTURE(known);
      CHECK(name(up) == known);
      glm::dvec3 axis{0.0};
      axis[up.axis] = up.sign;
      CHECK(up.to_y(axis) == glm::dvec3{0, 1, 0});
      const glm::dvec3 a{1, 2, 3}, b{-4, 5, 0.5};
      CHECK(glm::cross(up.to_y(a), up.to_y(b)) == up.to_y(glm::cross(a, b)));
      CHECK(up.from_y(up.to_y(a)) == a);
    }
    CHECK(Up{}.to_y({1, 2, 3}) == glm::dvec3{1, 2, 3});
  }

  TEST_CASE("of triangles with the same corners, in any order, at most six facets remain, under their first numbers") {
    std::array<glm::dvec3, 3> corners{{{0, 0, 0}, {0.5, 0.1, 0}, {0.2, 0.7, -0.3}}};
    std::vector<Facet> all;
    std::array<std::size_t, 3> order{0, 1, 2};
    for (int i = 0; i < 600; ++i) {
      all.push_back(make_facet(corners[order[0]], corners[order[1]], corners[order[2]]));
      all.push_back(make_facet(corners[0], corners[0], corners[1]));  // without area
      std::next_permutation(order.begin(), order.end());
    }
    const DistinctFacets distinct = distinct_facets(all);
    CHECK(distinct.triangles == std::vector<std::uint32_t>{0, 2, 4, 6, 8, 10});
    REQUIRE(distinct.facets.size() == 6);
    REQUIRE(distinct.places.size() == all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      CHECK(distinct.places[i] == (i % 2 == 1 ? no_facet : static_cast<std::uint32_t>(i / 2 % 6)));
  }

  TEST_CASE("facets that differ in one bit all remain") {
    std::vector<Facet> all;
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const auto random = uniform4(1, Stream::tests, i);
      const glm::dvec3 corner{random[0], random[1], random[2]};
      for (const double x : {0.5, std::nextafter(0.5, 1.0)})
        all.push_back(make_facet(corner, corner + glm::dvec3{x, 0, 0}, corner + glm::dvec3{0, random[3] + 0.1, 0.3}));
    }
    const DistinctFacets distinct = distinct_facets(all);
    std::size_t twins = 0;  // rounding of the edges may make two facets of a pair equal
    for (std::size_t i = 0; i < all.size(); i += 2) twins += all[i].first == all[i + 1].first ? 1 : 0;
    CHECK(twins < 900);
    CHECK(distinct.facets.size() == all.size() - twins);
  }
}
