#include "detp/sim/effects/self_shadow.hpp"

#include <doctest/doctest.h>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/geometry/directions.hpp"
#include "detp/sim/geometry/random.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "detp/sim/scene/vertices.hpp"

using namespace detp::sim;

namespace {

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.name = "test";
  scene.mesh = std::move(mesh);
  scene.samples = samples_at_vertices(scene.mesh, default_crease, scene.notices);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.lights = {{DirectionalLight{{-0.3, -0.8, -0.5}}}};
  return scene;
}

Finding shadow_in(const Scene& scene, bool front_facing = true) {
  return self_shadow(scene, caster_for(scene), front_facing).finding;
}

/// Floor and two walls that meet in a corner, seen from inside.
Mesh corner() {
  Mesh mesh;
  built_in::add_quad(mesh, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}, 0.1);
  built_in::add_quad(mesh, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 0.1);
  built_in::add_quad(mesh, {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}, 0.1);
  return mesh;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a corner shadows its discs; a box seen from outside does not") {
    const Finding inside = shadow_in(scene_of(corner()));
    CHECK(inside.value > 0.015);
    CHECK(inside.standard_error < 0.003);
    Mesh box;
    built_in::add_box(box, {0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0.1);
    CHECK(shadow_in(scene_of(box)).value == 0.01);
  }

  TEST_CASE("if both faces count, a ball of glass shadows the discs where light arrives inside") {
    Mesh ball;
    ball.materials.all = {{.name = "ball", .diffuse = 0, .glass = 1, .index = 1.5}};
    built_in::add_ball(ball, {0, 0, 0}, 1, 16);
    CHECK(shadow_in(scene_of(ball), false).value > 0.3);
  }

  TEST_CASE("a cloud of small leaves: light through them outweighs shadow") {
    Mesh leaves;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const auto random = uniform4(1, Stream::samples, 2 * i);
      const auto turned = uniform4(1, Stream::samples, 2 * i + 1);
      const glm::dvec3 centre{random[0], random[1], random[2]};
      const glm::dvec3 first = 0.02 * uniform_direction(turned[0], turned[1]);
      const glm::dvec3 second = 0.02 * uniform_direction(turned[2], turned[3]);
      built_in::add_quad(leaves, {{centre, centre + first, centre + first + second, centre + second}}, 0.05);
    }
    CHECK(shadow_in(scene_of(leaves), false).value < -0.01);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a stop request ends the search for self shadows") {
    std::stop_source source;
    const Scene scene = scene_of(corner());
    const auto caster = caster_for(scene);
    source.request_stop();
    CHECK_THROWS_AS((void)self_shadow(scene, caster, true, source.get_token()), Stopped);
  }
}
