#include "detp/sim/photons/landings.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"

using namespace detp::sim;

namespace {

/// A floor at z = 0 and a shelf at z = 1 above a quarter of it, of two triangles each.
Mesh floor_and_shelf() {
  Mesh mesh;
  for (const auto& [side, height] : {std::pair{2.0, 0.0}, {1.0, 1.0}}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {side, 0.0}, {side, side}, {0.0, side}})
      mesh.positions.emplace_back(x, y, height);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

struct Landed {
  Mesh mesh = floor_and_shelf();
  Box box = used_box(mesh);
  RayCaster caster{mesh, box};
  Paths paths = {};
};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a ray lands at its end, else where it first crosses the surface, else nowhere") {
    Landed one;
    const glm::dvec3 down{0, 0, -1};
    one.paths.rays = {{{1.5, 0.2, 3}, down, 3.00001},     // the floor, with a rounded length
                      {{0.6, 0.2, 3}, down, 2.5},         // through the shelf, and ends in the air below it
                      {{0.6, 0.2, 3}, down, 3},           // through the shelf to the floor
                      {{1.5, 0.2, 3}, down, 1},           // in the air
                      {{1.5, 0.2, 3}, down, unbounded}};  // a line
    const LandingCounts counts = land(one.paths, false, one.caster, one.box);
    CHECK(one.paths.triangles == std::vector<std::uint32_t>{0, 2, 0, no_triangle, no_triangle});
    CHECK(one.paths.landings[0] == doctest::Approx(3).epsilon(1e-12));
    CHECK(one.paths.landings[1] == doctest::Approx(2).epsilon(1e-12));
    CHECK(one.paths.landings[2] == doctest::Approx(3).epsilon(1e-12));
    CHECK(one.paths.landings[3] == unbounded);
    CHECK(counts.on_surface == 3);
    CHECK(counts.crossing == 1);
    CHECK(counts.elsewhere == 1);
    CHECK(counts.without_end == 1);
    CHECK(
        landing_notice(counts) ==
        "1 of 5 rays land where the scene has no surface: their photons are on no face; 1 of 5 rays have no end: their "
        "photons land nowhere; 1 of 5 rays end beyond the surface: they land where they first cross it");
  }

  TEST_CASE("landings that a file has stay, and get the triangle that is there") {
    Landed one;
    one.paths.rays = {{{0.6, 0.2, 3}, {0, 0, -1}, 5}, {{0.6, 0.2, 3}, {0, 0, -1}, 5}, {{0.6, 0.2, 3}, {0, 0, -1}, 5}};
    one.paths.landings = {2.00001, 2.5, unbounded};
    const LandingCounts counts = land(one.paths, true, one.caster, one.box);
    CHECK(one.paths.triangles == std::vector<std::uint32_t>{2, no_triangle, no_triangle});
    CHECK(one.paths.landings == std::vector<double>{2.00001, 2.5, unbounded});
    CHECK(counts.elsewhere == 1);
    CHECK(counts.nowhere == 1);
    CHECK(landing_notice({.on_surface = 5, .nowhere = 3}).empty());
  }

  TEST_CASE("photons of a photon map get the pieces of their paths: from the surface before, or from beyond the box") {
    Landed one;
    const glm::dvec3 slanted = glm::normalize(glm::dvec3{0, 0.1, -1});
    one.paths.rays = {{{1.5, 0.2, 0.00001}, {0, 0, -1}},  // from above
                      {{0.6, 0.2, 1}, {0, 0, 1}},         // from the floor to the shelf's lower side
                      {{0.6, 0.2, 0.5}, slanted}};        // in the air
    const LandingCounts counts = make_pieces(one.paths, one.caster, one.box, 0);
    const double diagonal = glm::length(one.box.size());
    const double gap = PhotonWalk::gap_share * diagonal;
    CHECK(counts.on_surface == 2);
    CHECK(counts.elsewhere == 1);
    CHECK(one.paths.triangles == std::vector<std::uint32_t>{0, 2, no_triangle});
    CHECK(one.paths.rays[0].origin.z == doctest::Approx(2 * diagonal));
    CHECK(one.paths.landings[0] == doctest::Approx(2 * diagonal));
    CHECK(one.paths.rays[1].origin.z == doctest::Approx(gap));
    CHECK(one.paths.landings[1] == doctest::Approx(1 - gap));
    CHECK(one.paths.rays[1].length == doctest::Approx(1));
    // In the air the photon landed all the same, on no triangle.
    CHECK(glm::distance(one.paths.rays[2].origin + one.paths.landings[2] * slanted, {0.6, 0.2, 0.5}) < 1e-9);
    Landed far;
    far.paths.rays = {{{0.6, 0.2, 1}, {0, 0, -1}}};
    (void)make_pieces(far.paths, far.caster, far.box, 0.3);
    CHECK(far.paths.rays[0].length - far.paths.landings[0] == doctest::Approx(0.3));
  }

  TEST_CASE("paths traced in a scene, without what is known of their landings, get it back; on any number of threads") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    const TracedPaths traced = photon_paths(scene, 3000, 1);
    const auto caster = caster_for(scene);
    for (const int threads : {1, 3}) {
      Paths paths = traced;
      paths.triangles.clear();
      (void)land(paths, true, *caster, scene.box, threads);
      CHECK(paths.triangles == traced.triangles);
      Paths map;
      std::vector<std::uint32_t> met;
      for (std::size_t i = 0; i < traced.rays.size(); ++i) {
        if (traced.landings[i] == unbounded) continue;
        const Ray& ray = traced.rays[i];
        map.rays.push_back({ray.origin + traced.landings[i] * ray.direction, ray.direction, unbounded, ray.power});
        met.push_back(traced.triangles[i]);
      }
      (void)make_pieces(map, *caster, scene.box, scene.overshoot, threads);
      CHECK(map.triangles == met);
      std::size_t again = 0;
      for (std::size_t i = 0; i < traced.rays.size(); ++i) {
        if (traced.landings[i] == unbounded) continue;
        CHECK(glm::distance(map.rays[again].origin, traced.rays[i].origin) < 3 * glm::length(scene.box.size()));
        CHECK(map.rays[again].length - map.landings[again] ==
              doctest::Approx(traced.rays[i].length - traced.landings[i]).epsilon(1e-6));
        ++again;
      }
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a photon that has landed has no length; a stop request is heard") {
    Landed one;
    one.paths.rays = {{{0, 0, 0}, {0, 0, 1}, 1}};
    CHECK_THROWS_AS((void)make_pieces(one.paths, one.caster, one.box, 0), std::invalid_argument);
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_WITH((void)land(one.paths, false, one.caster, one.box, 1, stop.get_token()),
                      doctest::Contains("stopped while"));
  }
}
