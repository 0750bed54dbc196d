#include "detp/sim/scene/up.hpp"
#include "detp/sim/open/open_scene.hpp"

#include <doctest/doctest.h>

#include "support/boxes.hpp"
#include "support/scratch_file.hpp"

using namespace detp::sim;
using detp::support::box_of;

namespace {

Up up_when_turned(Mesh mesh, const Up& to) {
  for (glm::dvec3& position : mesh.positions) position = to.from_y(position);
  return up_of(mesh, box_of(mesh));
}

}  // namespace

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
}

TEST_SUITE("known answer") {
  TEST_CASE("trees and courtyard: up is found whichever way they are turned") {
    for (const char* scene : {"@tree", "@tree-coarse", "@courtyard"}) {
      const Mesh mesh = open_scene({.name = scene, .samples = {}}).mesh;
      for (const auto& [name_of_up, up] : named_ups) {
        const std::string_view known = name_of_up;  // clang 14 cannot capture a binding
        CAPTURE(scene);
        CAPTURE(known);
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
