#include "detp/sim/reference/missed_light.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/reference/backward_paths.hpp"
#include "detp/sim/scene/resample.hpp"

namespace detp::sim {
namespace {

constexpr double half = 2;  ///< of the floor's side

/// The floor [-2, 2]² at z = 0: triangles 0 and 1, diffuse.
Scene floor_below(std::vector<Light> lights) {
  Scene scene;
  scene.name = "test";
  scene.mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.mesh.materials.all = {{.diffuse = 0.5}};
  scene.mesh.materials.of_triangle = {0, 0};
  scene.lights = std::move(lights);
  return scene;
}

void add_square(Scene& scene, const std::array<glm::dvec3, 4>& corners, std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.positions.size());
  scene.mesh.positions.insert(scene.mesh.positions.end(), corners.begin(), corners.end());
  for (const std::uint32_t other : {1U, 2U}) {
    scene.mesh.triangles.push_back({first, first + other, first + other + 1});
    scene.mesh.materials.of_triangle.push_back(material);
  }
}

Scene boxed(Scene scene) {
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  return scene;
}

const Light spot_from_above{SpotLight{{0, 0, 3}, {0, 0, -1}, 0.4}, 3};

/// A slab of glass, wide enough for a part of the spot's cone.
Scene glass_slab() {
  Scene scene = floor_below({spot_from_above});
  scene.mesh.materials.all.push_back({.diffuse = 0, .glass = 1, .index = 1.5});
  constexpr double w = 0.5;
  add_square(scene, {{{-w, -w, 1.2}, {w, -w, 1.2}, {w, w, 1.2}, {-w, w, 1.2}}}, 1);
  add_square(scene, {{{-w, -w, 1}, {-w, w, 1}, {w, w, 1}, {w, -w, 1}}}, 1);
  for (const auto& [x, y] :
       {std::array{1.0, 0.0}, std::array{0.0, 1.0}, std::array{-1.0, 0.0}, std::array{0.0, -1.0}}) {
    const glm::dvec3 out(x, y, 0);
    const glm::dvec3 along(-y, x, 0);
    const glm::dvec3 low = w * out + glm::dvec3(0, 0, 1);
    const glm::dvec3 up(0, 0, 0.2);
    add_square(scene, {{low - w * along, low + w * along, low + w * along + up, low - w * along + up}}, 1);
  }
  return boxed(std::move(scene));
}

/// A mirror that turns a spot's level light down, to the floor; and a lamp.
Scene mirror(double shininess, double diffuse) {
  Scene scene = floor_below(
      {{SpotLight{{-1.5, 0, 1.5}, {1, 0, 0}, 0.2}, 3}, {AreaLight{{-0.5, -0.5, 2.5}, {0, 1, 0}, {1, 0, 0}}, 1}});
  scene.mesh.materials.all.push_back({.diffuse = diffuse, .specular = 0.9 - diffuse, .shininess = shininess});
  add_square(scene, {{{0.1, -0.5, 1.9}, {0.9, -0.5, 1.1}, {0.9, 0.5, 1.1}, {0.1, 0.5, 1.9}}}, 1);
  return boxed(std::move(scene));
}

struct FloorMean {
  double value = 0;
  double error = 0;
};

/// Mean irradiance of the floor by photons that land there.
FloorMean on_floor(const Paths& paths) {
  constexpr double area = 4 * half * half;
  double sum = 0;
  double squares = 0;
  double open = 0;  // of the photon at hand
  for (std::size_t i = 0; i < paths.rays.size(); ++i) {
    if (paths.triangles[i] < 2) open += paths.rays[i].power / area;
    if (i + 1 < paths.rays.size() && paths.photons[i + 1] == paths.photons[i]) continue;
    sum += open;
    squares += open * open;
    open = 0;
  }
  return {sum, std::sqrt(squares)};
}

/// The same by backward paths.
FloorMean found_on_floor(const Scene& scene) {
  Mesh alone = scene.mesh;
  alone.triangles.resize(2);
  std::vector<Sample> samples;
  add_by_area(samples, alone, 20'000, 5);
  std::vector<PathSums> sums(samples.size());
  add_backward_paths(BackwardPaths(scene, 7), samples, 8, false, sums);
  FloorMean mean;
  for (const PathSums& one : sums) mean.value += one.irradiance() / 20'000;
  for (const PathSums& one : sums) mean.error += std::pow((one.irradiance() - mean.value) / 20'000, 2);
  return {mean.value, std::sqrt(mean.error)};
}

double landed(const Paths& paths) {
  double sum = 0;
  for (std::size_t i = 0; i < paths.rays.size(); ++i) sum += paths.landings[i] < unbounded ? paths.rays[i].power : 0;
  return sum;
}

}  // namespace

TEST_SUITE("missed light") {
  TEST_CASE("what backward paths find and what they miss is all light: glass, a mirror, gloss with some diffuse light" *
            doctest::test_suite("long")) {
    for (const Scene& scene : {glass_slab(), mirror(std::numeric_limits<double>::infinity(), 0), mirror(40, 0.3)}) {
      INFO("scene.mesh.triangles.size() ", scene.mesh.triangles.size(), ", scene.mesh.materials.all[1].diffuse ",
           scene.mesh.materials.all[1].diffuse);
      const Paths all = photon_paths(scene, 400'000, 3);
      const Paths missed = missed_light(scene, caster_for(scene), 3, all.photon_count);
      const FloorMean by_all = on_floor(all);
      const FloorMean by_missed = on_floor(missed);
      const FloorMean found = found_on_floor(scene);
      const double error = std::hypot(by_all.error, found.error);
      CHECK(error < 0.03 * by_all.value);
      CHECK(std::abs(found.value + by_missed.value - by_all.value) < 4 * error);
      CHECK(found.value > 10 * error);
      CHECK(std::abs(found.value - by_all.value) > 8 * error);  // negative control
    }
  }

  TEST_CASE("missed rays are rays of the paths as they are, none of them a photon's first; powers are of all photons") {
    const Scene scene = glass_slab();
    const Paths all = photon_paths(scene, 20'000, 3);
    const Paths missed = missed_light(scene, caster_for(scene), 3, all.photon_count);
    CHECK(missed.photon_count == all.photon_count);
    REQUIRE(missed.rays.size() > 1000);
    std::size_t at = 0;
    for (std::size_t i = 0; i < missed.rays.size(); ++i) {
      while (all.photons[at] != missed.photons[i] || all.rays[at].origin != missed.rays[i].origin) ++at;
      REQUIRE(all.photons[at - 1] == missed.photons[i]);
      // photon_paths counts the last photon's path by a share of its own
      CHECK(all.rays[at].power == doctest::Approx(missed.rays[i].power).epsilon(0.01));
      CHECK(all.landings[at] == missed.landings[i]);
      CHECK(all.triangles[at] == missed.triangles[i]);
    }
  }

  TEST_CASE("the share of missed light is that of the rays; all bytes are the same when it is asked again") {
    const Scene scene = glass_slab();
    const Paths all = photon_paths(scene, 400'000, 3);
    const double share = landed(missed_light(scene, caster_for(scene), 3, all.photon_count)) / landed(all);
    const MissedShare found = missed_share(scene, nullptr, 8, 20'000);
    CHECK(found.share == doctest::Approx(share).epsilon(0.03));
    CHECK(found.upper_bound > found.share);
    CHECK(found.upper_bound < 1.05 * found.share);
    CHECK(found.photons == 20'000);
    CHECK(missed_share(scene, caster_for(scene), 8, 20'000).share == found.share);
  }

  TEST_CASE("without lights that have no extent nothing is missed: the bound is 0, and no photon is traced") {
    Scene scene = glass_slab();
    scene.lights = {{AreaLight{{-0.5, -0.5, 2.5}, {0, 1, 0}, {1, 0, 0}}, 1}};
    const Paths all = photon_paths(scene, 1000, 3);
    CHECK(missed_light(scene, caster_for(scene), 3, all.photon_count).rays.empty());
    const MissedShare none = missed_share(scene, nullptr, 8, 1000);
    CHECK(none.share == 0);
    CHECK(none.upper_bound == 0);
    CHECK(none.photons == 0);
  }

  TEST_CASE("where no photon met glass, the bound says how much it may be") {
    Scene scene = floor_below({spot_from_above});
    scene.mesh.materials.all.push_back({.diffuse = 0, .glass = 1, .index = 1.5});
    add_square(scene, {{{1.8, 1.8, 2.8}, {1.9, 1.8, 2.8}, {1.9, 1.9, 2.8}, {1.8, 1.9, 2.8}}}, 1);
    scene = boxed(std::move(scene));
    for (const std::uint64_t photons : {1, 100, 10'000}) {
      CAPTURE(photons);
      const MissedShare none = missed_share(scene, nullptr, 8, photons);
      CHECK(none.share == 0);
      CHECK(none.upper_bound > 0);
      CHECK(none.upper_bound <= std::min(1.0, 30.0 / static_cast<double>(photons)));
    }
    std::stop_source source;
    source.request_stop();
    const MissedShare stopped = missed_share(scene, nullptr, 8, 100, source.get_token());
    CHECK(stopped.upper_bound == 1);
    CHECK(stopped.photons == 0);
  }
}

}  // namespace detp::sim
