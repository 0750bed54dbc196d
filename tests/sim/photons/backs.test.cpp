#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "detp/sim/photons/emitter.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "detp/sim/scene/coincident.hpp"

using namespace detp::sim;
using std::numbers::pi;

namespace {

/// Flux that lands on the planes z = 0, or on all surfaces.
class LandedFlux {
 public:
  LandedFlux(const Scene& scene, std::uint64_t photons, bool on_ground) : scene_(scene), on_ground_(on_ground) {
    const PhotonWalk walk(scene, 1);
    double squares = 0;
    for (std::uint64_t photon = 0; photon < photons; ++photon) {
      of_photon_ = 0;
      (void)walk.follow(photon, *this);
      sum += of_photon_ / static_cast<double>(photons);
      squares += of_photon_ * of_photon_;
    }
    error_ = std::sqrt(squares) / static_cast<double>(photons);
  }

  void piece(const Ray&, double) {}
  void met(std::uint32_t triangle, double power, bool) {
    const auto& positions = scene_.mesh.positions;
    for (const std::uint32_t corner : scene_.mesh.triangles[triangle])
      if (on_ground_ && positions[corner].z != 0) return;
    of_photon_ += power;
  }

  double sum = 0;
  [[nodiscard]] double error() const { return error_; }

 private:
  const Scene& scene_;
  bool on_ground_;
  double of_photon_ = 0;
  double error_ = 0;  ///< a bound: the standard error of a sum whose mean were 0
};

/// The lights are the emitting triangles.
Scene lit(Mesh mesh) {
  Scene scene;
  scene.name = "lit";
  scene.mesh = std::move(mesh);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.lights = {{SurfaceLight{}, emitted_flux(scene.mesh)}};
  return scene;
}

Mesh joined(Mesh mesh) {
  Notices notices;
  join_coincident(mesh, notices);
  return mesh;
}

constexpr std::uint16_t ground = 0;
constexpr std::uint16_t lamp = 1;

void add_ground(Mesh& mesh, double cell) {
  built_in::add_quad(mesh, {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}}, cell);
  built_in::paint(mesh, ground);
}

/// Looks down.
void add_lamp(Mesh& mesh, double cell) {
  built_in::add_quad(mesh, {{{1, 1, 2}, {1, 3, 2}, {3, 3, 2}, {3, 1, 2}}}, cell);
  built_in::paint(mesh, lamp);
}

Mesh with_materials() {
  Mesh mesh;
  mesh.materials.all = {{.name = "ground", .diffuse = 0.5}, {.name = "lamp", .diffuse = 0.5, .emitted = 3}};
  return mesh;
}

/// A closed box of side 2; in its inside is a furnace of radiance 1 and albedo 0.5, outside it is black and brighter.
Mesh two_sided_box() {
  Mesh mesh;
  built_in::add_box(mesh, {-1, -1, -1}, {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}}, 0.5);
  built_in::paint(mesh, 0);
  const std::size_t outside = mesh.triangles.size();
  built_in::add_box(mesh, {-1, -1, -1}, {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}}, 0.5);
  for (std::size_t i = outside; i < mesh.triangles.size(); ++i) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  built_in::paint(mesh, 1);
  mesh.materials.all = {{.name = "outside", .diffuse = 0, .emitted = 2}, {.name = "inside", .emitted = 1}};
  return mesh;
}

constexpr double box_faces = 24;  // area of the box

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("ground and lamps that are listed twice give the same photons as listed once") {
    Mesh once = with_materials();
    add_ground(once, 1);
    add_lamp(once, 0.5);
    Mesh twice = once;
    add_lamp(twice, 2);
    add_ground(twice, 4);
    CHECK(emitted_flux(joined(twice)) == emitted_flux(once));
    CHECK(LandedFlux(lit(joined(twice)), 2000, true).sum == LandedFlux(lit(once), 2000, true).sum);
    CHECK(emitted_flux(twice) == doctest::Approx(2 * emitted_flux(once)));
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("ground and lamps in another tessellation give the light of those listed once; twice the lamps do not") {
    Mesh once = with_materials();
    add_ground(once, 1);
    add_lamp(once, 0.5);
    Mesh twice = with_materials();
    add_lamp(twice, 0.7);
    add_ground(twice, 1.4);
    add_ground(twice, 1);
    add_lamp(twice, 0.5);
    constexpr std::uint64_t photons = 200'000;
    const LandedFlux single(lit(once), photons, true);
    const LandedFlux both(lit(joined(twice)), photons, true);
    CHECK(std::abs(both.sum - single.sum) < 4.5 * std::hypot(single.error(), both.error()));
    const LandedFlux unjoined(lit(twice), photons, true);
    CHECK(std::abs(unjoined.sum - single.sum) > 20 * std::hypot(single.error(), unjoined.error()));
  }

  TEST_CASE("backs emit and scatter by their own material: a furnace whose walls are backs, forwards and backwards") {
    const Scene scene = lit(joined(two_sided_box()));
    REQUIRE(scene.mesh.materials.of_back.size() == scene.mesh.triangles.size());
    CHECK(emitted_flux(scene.mesh) == doctest::Approx(3 * pi * box_faces));
    const LandedFlux landed(scene, 200'000, false);
    CHECK(std::abs(landed.sum - 2 * pi * box_faces) < 4.5 * landed.error());
    CHECK(landed.error() < 0.01 * landed.sum);
    const BackwardPaths paths(scene, 1);
    double sum = 0;
    double squares = 0;
    constexpr std::uint64_t count = 20'000;
    for (std::uint64_t path = 0; path < count; ++path) {
      const double one = paths.irradiance({.position = {0.3, 0.2, -0.4}, .normal = {0, 0.6, 0.8}}, 0, path, true);
      sum += one / count;
      squares += one * one / count;
    }
    CHECK(std::abs(sum - 2 * pi) < 4.5 * std::sqrt((squares - sum * sum) / count));
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("a photon meets the material of its side, with the normal of the triangle that the material came from") {
    const Materials materials{
        .all = {{.name = "front"}, {.name = "back"}}, .of_triangle = {0, 0}, .of_back = {1, no_back}};
    const glm::dvec3 normal{0, 0, 1};
    for (const double way : {1.0, -1.0}) {
      const bool front = way < 0;
      const Side side = side_met(materials, 0, normal, {0, 0, way});
      CHECK(side.material.name == (front ? "front" : "back"));
      CHECK(side.normal.z == (front ? 1 : -1));
      const Side other = side_met(materials, 1, normal, {0, 0, way});
      CHECK(other.material.name == "front");
      CHECK(other.normal.z == 1);
    }
  }
}
