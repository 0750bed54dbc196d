#include "detp/sim/effects/self_shadow.hpp"

#include <doctest/doctest.h>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"

using namespace detp::sim;

namespace {

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.name = "test";
  scene.mesh = std::move(mesh);
  scene.samples = samples_at_vertices(scene.mesh, scene.notices);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.lights = {{DirectionalLight{{-0.3, -0.8, -0.5}}}};
  return scene;
}

std::vector<Disc> discs_at(const Scene& scene, double radius) {
  std::vector<Disc> discs;
  for (const Sample& sample : scene.samples) discs.push_back({sample.position, sample.normal, radius});
  return discs;
}

Finding shadow_in(const Scene& scene, double radius) {
  return self_shadow(scene, caster_for(scene), discs_at(scene, radius), true, 1);
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
    const Finding inside = shadow_in(scene_of(corner()), 0.1);
    CHECK(inside.value > 0.05);
    CHECK(inside.standard_error < 0.02);
    Mesh box;
    built_in::add_box(box, {0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 0.1);
    CHECK(shadow_in(scene_of(box), 0.1).value == 0);
  }

  TEST_CASE(
      "if both faces count, a ball of glass shadows the discs where light arrives inside, an opaque one does not") {
    for (const double glass : {0.0, 1.0}) {
      Mesh ball;
      ball.materials.all = {{.name = "ball", .diffuse = 0, .glass = glass, .index = 1.5}};
      built_in::add_ball(ball, {0, 0, 0}, 1, 16);
      const Scene scene = scene_of(ball);
      const Finding found = self_shadow(scene, caster_for(scene), discs_at(scene, 0.05), false, 1);
      if (glass > 0)
        CHECK(found.value > 0.3);
      else
        CHECK(found.value < 0.01);
    }
  }

  TEST_CASE("a stack of thin uneven sheets: light through them outweighs shadow") {
    Mesh sheets;
    for (int i = 0; i < 6; ++i)
      built_in::add_patch(sheets, {20, 20}, [i](double u, double v) {
        return glm::dvec3{v, 0.05 * i + 0.01 * ((static_cast<int>(20 * u) + static_cast<int>(20 * v)) % 2), u};
      });
    const Finding finding = shadow_in(scene_of(sheets), 0.05);
    CHECK(finding.value < -0.1);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a stop request ends the search for self shadows") {
    std::stop_source source;
    const Scene scene = scene_of(corner());
    const auto caster = caster_for(scene);
    source.request_stop();
    CHECK_THROWS_AS((void)self_shadow(scene, caster, discs_at(scene, 0.1), true, 1, source.get_token()), Stopped);
  }
}
