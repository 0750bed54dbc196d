#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>

#include "detp/sim/photons/emitter.hpp"
#include "support/flat_meshes.hpp"

using namespace detp::sim;
using namespace detp::support;

namespace {

/// Radiance of a side times area, over all triangles: of fronts that look up and backs that look down, and the others.
std::array<double, 2> up_and_down(const Mesh& mesh) {
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const bool up = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]).z > 0;
    for (const bool front : {true, false})
      sums[front == up ? 0 : 1] += mesh.materials.emitted(i, front) * 0.5 * doubled_area(mesh, mesh.triangles[i]);
  }
  return sums;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("of lamps in one place that face the same way, the brighter one emits; of those back to back, both do") {
    for (const bool same : {true, false})
      for (const std::size_t bright : {std::size_t{0}, std::size_t{1}}) {
        Mesh mesh = unit_square();
        add_rectangle(mesh, {0, 0}, {1, 1}, same ? 1 : 3, 2);
        const std::size_t in_second = mesh.triangles.size() - 2;
        if (!same) turn_from(mesh, 2);
        mesh.materials.all = {{.name = "bright", .emitted = 4}, {.name = "dim", .emitted = 3}};
        mesh.materials.of_triangle.assign(2, bright == 0 ? 0 : 1);
        mesh.materials.of_triangle.resize(2 + in_second, bright == 0 ? 1 : 0);
        Notices notices;
        Mesh after = mesh;
        join_coincident(after, notices);
        check(after.materials, after.triangles.size());
        const auto [up, down] = up_and_down(after);
        const double other = same ? 0 : 3;
        CHECK(std::max(up, down) == doctest::Approx(4).epsilon(1e-9));
        CHECK(std::min(up, down) == doctest::Approx(other).epsilon(1e-9));
        CHECK((same || (up > down) == (bright == 0)));
        CHECK(emitted_flux(after) == doctest::Approx(std::numbers::pi * (4 + other)).epsilon(1e-9));
        CHECK(notices.size() == (same ? 2 : 1));
      }
  }

  TEST_CASE("a lamp that lies with its back on a part of the floor is whole, and its back is the floor") {
    for (const bool lamp_first : {true, false}) {
      Mesh mesh;
      if (lamp_first) add_rectangle(mesh, {1, 1}, {2, 2});
      add_rectangle(mesh, {0, 0}, {4, 4});
      if (!lamp_first) add_rectangle(mesh, {1, 1}, {2, 2});
      turn_from(mesh, 2);  // the lamp, or the floor
      mesh.materials.all = {{.name = "floor"}, {.name = "lamp", .emitted = 2}};
      mesh.materials.of_triangle =
          lamp_first ? std::vector<std::uint16_t>{1, 1, 0, 0} : std::vector<std::uint16_t>{0, 0, 1, 1};
      const Mesh after = joined(mesh);
      check(after.materials, after.triangles.size());
      CHECK(area_of(after) == doctest::Approx(16).epsilon(1e-9));
      CHECK(emitted_flux(after) == doctest::Approx(2 * std::numbers::pi).epsilon(1e-9));
      double floor_behind_lamp = 0;
      for (std::size_t i = 0; i < after.triangles.size(); ++i)
        if (after.materials.of(i).emitted > 0 && after.materials.of(i, false).emitted == 0)
          floor_behind_lamp += 0.5 * doubled_area(after, after.triangles[i]);
      CHECK(floor_behind_lamp == doctest::Approx(1).epsilon(1e-9));
    }
  }

  TEST_CASE("a back with another material divides the first triangle only where it lies; the same material does not") {
    Mesh mesh;
    add_rectangle(mesh, {0, 0}, {4, 4});
    add_rectangle(mesh, {1, 1}, {2, 2}, 3, 3);
    turn_from(mesh, 2);
    mesh.materials.all = {{.name = "floor"}, {.name = "wood", .diffuse = 0.2}};
    CHECK(joined(mesh).triangles.size() == 2);
    CHECK(joined(mesh).materials.of_triangle.empty());
    mesh.materials.of_triangle.assign(mesh.triangles.size(), 1);
    mesh.materials.of_triangle[0] = mesh.materials.of_triangle[1] = 0;
    const Mesh after = joined(mesh);
    check(after.materials, after.triangles.size());
    REQUIRE(after.materials.of_back.size() == after.triangles.size());
    double wood = 0;
    for (std::size_t i = 0; i < after.triangles.size(); ++i) {
      CHECK(after.materials.of(i).name == "floor");
      if (after.materials.of(i, false).name == "wood") wood += 0.5 * doubled_area(after, after.triangles[i]);
    }
    CHECK(wood == doctest::Approx(1).epsilon(1e-9));
    CHECK(is_untouched(after));
    Mesh again = after;  // what has a back keeps it when something else is joined
    add_rectangle(again, {2, 2}, {3, 3});
    again.materials.of_triangle.resize(again.triangles.size(), 0);
    again.materials.of_back.resize(again.triangles.size(), no_back);
    again = joined(again);
    CHECK(again.triangles == after.triangles);
    CHECK(again.materials.of_back == after.materials.of_back);
    CHECK(area_of(after) == doctest::Approx(16).epsilon(1e-9));
  }

  TEST_CASE("a lamp listed once for each side, in one material, emits on both") {
    Mesh mesh = unit_square();
    for (const auto& [a, b, c] : unit_square().triangles) mesh.triangles.push_back({a, c, b});
    mesh.materials.all = {{.emitted = 1}};
    const Mesh after = joined(mesh);
    CHECK(after.triangles == unit_square().triangles);
    CHECK(after.materials.of_back == std::vector<std::uint16_t>{0, 0});
    CHECK(emitted_flux(after) == doctest::Approx(2 * std::numbers::pi));
  }

  TEST_CASE("numbers of backs are checked") {
    Materials materials{.all = {{}, {}}, .of_triangle = {}, .of_back = {0, no_back, 1}};
    CHECK_NOTHROW(check(materials, 3));
    CHECK_THROWS_WITH_AS(check(materials, 2), "each triangle's back needs a material (3 for 2 triangles)",
                         std::invalid_argument);
    materials.of_back[1] = 2;
    CHECK_THROWS_WITH_AS(check(materials, 3), "there is no material 2 (counting from 0); there are 2",
                         std::invalid_argument);
  }
}
