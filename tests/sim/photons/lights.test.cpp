#include "detp/sim/photons/lights.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "detp/sim/geometry/random.hpp"
#include "detp/sim/photons/placed_lights.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "support/boxes.hpp"

using namespace detp::sim;
using detp::support::box_of;

namespace {

/// Two squares in the plane z = 0, of sides 1 and 2, with materials 0 and 1; the box reaches up to z = 2.
Scene two_squares(std::vector<Light> lights) {
  Scene scene;
  scene.name = "two squares";
  built_in::add_quad(scene.mesh, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 1);
  built_in::add_quad(scene.mesh, {{{2, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}}}, 2);
  scene.mesh.materials = {.all = {{.emitted = 8}, {.emitted = 1}}, .of_triangle = {0, 0, 1, 1}};
  scene.box = {{0, 0, 0}, {4, 2, 2}};
  scene.lights = std::move(lights);
  return scene;
}

std::vector<PhotonStart> starts(const Light& light, std::uint64_t count) {
  const Emitter emitter = emitter_of(light, two_squares({}));
  std::vector<PhotonStart> all;
  for (std::uint64_t i = 0; i < count; ++i) all.push_back(emitter(uniform4(1, Stream::tests, i)));
  return all;
}

constexpr double radius = 2.4494897427831781;  // of the sphere around the box
constexpr glm::dvec3 middle{2, 1, 1};

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
  TEST_CASE("a spot stays in its cone, and fills it evenly; one of half angle pi shines everywhere") {
    const auto all = starts({SpotLight{{1, 2, 3}, {0, 0, -2}, 0.5}}, 20'000);
    double inner = 0;
    for (const PhotonStart& one : all) {
      CHECK(one.origin == glm::dvec3{1, 2, 3});
      CHECK(-one.direction.z > std::cos(0.5) - 1e-12);
      if (-one.direction.z > std::cos(0.25)) ++inner;
    }
    const double share = (1 - std::cos(0.25)) / (1 - std::cos(0.5));
    CHECK(std::abs(inner / 20'000 - share) < 4.5 * std::sqrt(share * (1 - share) / 20'000));
    double behind = 0;
    for (const PhotonStart& one : starts({SpotLight{{1, 2, 3}, {0, 0, -2}, std::numbers::pi}}, 20'000))
      if (one.direction.z > 0) ++behind;
    CHECK(std::abs(behind / 20'000 - 0.5) < 4.5 * 0.5 / std::sqrt(20'000.0));
  }

  TEST_CASE("a directional light is a parallel beam as wide as the sphere around the box, from outside") {
    const glm::dvec3 direction = glm::normalize(glm::dvec3{1, -2, 0.5});
    double inner = 0;
    for (const PhotonStart& one : starts({DirectionalLight{{10, -20, 5}}}, 20'000)) {
      CHECK(glm::length(one.direction - direction) < 1e-15);
      CHECK(glm::dot(one.origin - middle, direction) == doctest::Approx(-radius).epsilon(1e-5));
      const double across = glm::length(glm::cross(one.origin - middle, direction));
      CHECK(across < 1.0001 * radius);
      if (across < radius / 2) ++inner;
    }
    CHECK(std::abs(inner / 20'000 - 0.25) < 4.5 * std::sqrt(0.1875 / 20'000));
  }

  TEST_CASE("an environment sends uniform isotropic lines: a quarter meets a sphere of half the radius") {
    double met = 0;
    double sum = 0;
    for (const PhotonStart& one : starts({EnvironmentLight{}}, 40'000)) {
      CHECK(glm::length(one.origin - middle) == doctest::Approx(radius).epsilon(1e-5));
      if (glm::length(glm::cross(one.origin - middle, one.direction)) < radius / 2) ++met;
      sum += one.direction.z;
    }
    CHECK(std::abs(met / 40'000 - 0.25) < 4.5 * std::sqrt(0.1875 / 40'000));
    CHECK(std::abs(sum / 40'000) < 4.5 * std::sqrt(1.0 / 3 / 40'000));
  }

  TEST_CASE("emitting triangles share photons by area times radiance, and know where photons start") {
    const Scene scene = two_squares({});
    CHECK(emitted_flux(scene.mesh) == doctest::Approx(std::numbers::pi * (8 + 4)));
    double first = 0;
    for (const PhotonStart& one : starts({SurfaceLight{}}, 30'000)) {
      REQUIRE(one.triangle);
      CHECK(one.direction.z > 0);
      CHECK(one.origin.z == 0);
      CHECK((one.origin.x <= 1) == (*one.triangle < 2));
      if (one.origin.x <= 1) ++first;
    }
    CHECK(std::abs(first / 30'000 - 2.0 / 3) < 4.5 * std::sqrt(2.0 / 9 / 30'000));
  }

  TEST_CASE("photons go by power; a dim light gets at least a tenth of an even share, with weaker photons") {
    const std::vector<Light> lights{
        {PointLight{{0, 0, 1}}, 98}, {PointLight{{0, 0, 2}}, 2}, {PointLight{{0, 0, 3}}, 0}};
    const Scene scene = two_squares(lights);
    const Lights all(scene);
    constexpr std::uint64_t count = 1 << 16;
    std::array<double, 4> photons{};
    std::array<double, 4> power{};
    for (std::uint64_t i = 0; i < count; ++i) {
      const EmittedPhoton photon = all.photon(i, uniform4(1, Stream::tests, i));
      const auto place = static_cast<std::size_t>(photon.start.origin.z);
      ++photons[place];
      power[place] += photon.power;
    }
    CHECK(photons[1] / count == doctest::Approx(0.9 * 0.98 + 0.05).epsilon(1e-4));
    CHECK(photons[2] / count == doctest::Approx(0.9 * 0.02 + 0.05).epsilon(1e-3));
    CHECK(photons[3] == 0);
    CHECK(power[1] / count == doctest::Approx(98).epsilon(1e-4));
    CHECK(power[2] / count == doctest::Approx(2).epsilon(1e-3));
  }

  TEST_CASE("a single light gives every photon its whole flux") {
    const Scene scene = two_squares({{PointLight{}, 7}});
    const Lights all(scene);
    for (std::uint64_t i = 0; i < 10; ++i) CHECK(all.power(i) == 7);
  }

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

TEST_SUITE("bad input") {
  TEST_CASE("lights without direction, finite numbers, flux or emitting triangles are refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refuses = [](const Light& light, const char* message) {
      const Scene scene = two_squares({light});
      CHECK_THROWS_WITH_AS(Lights{scene}, doctest::Contains(message), std::invalid_argument);
    };
    refuses({DirectionalLight{{0, 0, 0}}}, "direction of the directional light must not be zero");
    refuses({DirectionalLight{{0, nan, 0}}}, "direction of the directional light must be finite");
    refuses({SpotLight{{0, 0, 0}, {0, 0, 0}, 1}}, "direction of the spot light must not be zero");
    refuses({SpotLight{{0, nan, 0}, {0, 0, 1}, 1}}, "position of the spot light must be finite");
    refuses({SpotLight{{0, 0, 0}, {0, 0, 1}, 4}}, "half angle of the spot light must be at most pi");
    refuses({SpotLight{{0, 0, 0}, {0, 0, 1}, 0}}, "half angle of the spot light must be > 0");
    refuses({PointLight{}, -1}, "flux of a light must be >= 0");
    refuses({PointLight{}, nan}, "flux of a light");
    refuses({PointLight{}, 0}, "flux of all lights must be > 0");
    refuses({PointLight{}, 1e-310}, "flux of a light must be 0 or at least 2.225e-308");
    Scene dark = two_squares({{SurfaceLight{}}});
    dark.mesh.materials = {};
    CHECK_THROWS_WITH_AS(Lights{dark}, "no triangle of two squares emits light; give a material that emits",
                         std::invalid_argument);
    const Scene none = two_squares({});
    CHECK_THROWS_WITH_AS(Lights{none}, "photon paths need a light; two squares has none", std::invalid_argument);
  }
}
