#include "detp/sim/photons/placed_lights.hpp"

#include <doctest/doctest.h>

#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::support::box_of;

namespace {

/// The six faces of a box.
Mesh box_mesh(const glm::dvec3& low, const glm::dvec3& size) {
  Mesh mesh;
  built_in::add_box(mesh, low, {{{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}}}, 0.5 * glm::length(size));
  return mesh;
}

AreaLight light_for(const Mesh& mesh, const Box& box, const Up& up = {}) {
  return std::get<AreaLight>(placed_lights(std::array{LightKind::area}, mesh, box, up).at(0).shape);
}

void add(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + base, b + base, c + base});
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("in a closed room the light hangs 1 % below the ceiling, half as wide as the room, at any scale") {
    for (const double scale : {1e-13, 1.0, 1e12})
      for (const double offset : {0.0, 5e6}) {
        const glm::dvec3 corner = offset * scale * glm::dvec3{1, 2, -1};
        const Mesh room = box_mesh(corner, scale * glm::dvec3{4, 2, 8});
        const AreaLight light = light_for(room, box_of(room));
        const glm::dvec3 relative = (light.corner - corner) / scale;
        CHECK(relative.x == doctest::Approx(1).epsilon(1e-8));
        CHECK(relative.y == doctest::Approx(1.98).epsilon(1e-8));
        CHECK(relative.z == doctest::Approx(2).epsilon(1e-8));
        CHECK(light.edge_u.x / scale == doctest::Approx(2).epsilon(1e-8));
        CHECK(light.edge_v.z / scale == doctest::Approx(4).epsilon(1e-8));
        CHECK(glm::cross(light.edge_u, light.edge_v).y < 0);
      }
  }

  TEST_CASE("under a ceiling of 8 % thickness the light hangs in the room, not in the ceiling") {
    Mesh room = box_mesh({0, 0, 0}, {4, 2, 4});
    add(room, box_mesh({0, 1.84, 0}, {4, 0.16, 4}));
    const AreaLight light = light_for(room, box_of(room));
    CHECK(light.corner.y < 1.84);
    CHECK(light.corner.y > 1.7);
  }

  TEST_CASE("over flat land the light hangs at half the longest side") {
    Mesh land;
    built_in::add_quad(land, {{{0, 2, 0}, {0, 2, 6}, {10, 2, 6}, {10, 2, 0}}}, 1);
    CHECK(light_for(land, box_of(land)).corner.y == doctest::Approx(7));
  }

  TEST_CASE("a wall that is flat in X or in Z still gets a light with an area, inside its height") {
    Mesh across_x;
    built_in::add_quad(across_x, {{{1, 0, 0}, {1, 0, 6}, {1, 6, 6}, {1, 6, 0}}}, 1);
    Mesh across_z;
    built_in::add_quad(across_z, {{{0, 0, 1}, {6, 0, 1}, {6, 6, 1}, {0, 6, 1}}}, 1);
    for (const Mesh& wall : {across_x, across_z}) {
      const AreaLight light = light_for(wall, box_of(wall));
      CHECK(glm::length(glm::cross(light.edge_u, light.edge_v)) == doctest::Approx(3 * 0.3));
      CHECK(light.corner.y == doctest::Approx(5.94));
    }
  }
}
