#include "detp/sim/reference/backward_paths.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/sim/estimate/estimate.hpp"
#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/scene/built_in/built_in.hpp"
#include "detp/sim/scene/resample.hpp"

namespace detp::sim {
namespace {

using std::numbers::pi;

struct Mean {
  double value = 0;
  double error = 0;
};

/// Over the samples.
Mean backward(const Scene& scene, const std::vector<Sample>& samples, std::uint64_t paths, bool front_facing = false) {
  const BackwardPaths walk(scene, 7);
  std::vector<PathSums> sums(samples.size());
  add_backward_paths(walk, samples, paths, front_facing, sums);
  Mean mean;
  for (const PathSums& one : sums) {
    mean.value += one.irradiance() / static_cast<double>(samples.size());
    mean.error += one.variance();
  }
  mean.error = std::sqrt(mean.error) / static_cast<double>(samples.size());
  return mean;
}

Scene scene_of(const Mesh& mesh, std::vector<Light> lights) {
  Scene scene;
  scene.name = "test";
  scene.mesh = mesh;
  scene.lights = std::move(lights);
  for (const glm::dvec3& position : mesh.positions) scene.box.include(position);
  return scene;
}

/// The square [-1, 1]² at z = 0, black, and a small square far above it, so that the box has a height.
Scene black_floor(const Light& light, double diffuse = 0) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 2}, {-0.999, -1, 2}, {-1, -0.999, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  mesh.materials.all = {{.diffuse = diffuse}};
  return scene_of(mesh, {light});
}

}  // namespace

TEST_SUITE("backward paths: known answers") {
  TEST_CASE("one sample before each kind of light") {
    const std::vector<Sample> middle{{{0.1, 0.05, 0}, {0, 0, 1}}};
    const auto irradiance = [&](const Light& light) { return backward(black_floor(light), middle, 64 * 256); };
    const double radius = 0.5 * (1 + 1e-6) * std::sqrt(12.0);
    const auto check = [](const Mean& found, double known, double slack = 1e-9) {
      CHECK(std::abs(found.value - known) <= 4 * found.error + slack * known);
      CHECK(found.error <= 0.02 * known);
    };
    check(irradiance({PointLight{{0.1, 0.05, 2}}, 3}), 3 / (4 * pi) / 4);
    check(irradiance({SpotLight{{0.1, 0.05, 2}, {0, 0, -1}, 0.3}, 3}), 3 / (2 * pi * (1 - std::cos(0.3))) / 4);
    check(irradiance({SpotLight{{0.1, 0.05, 2}, {1, 0, 0}, 0.3}, 3}), 0);
    check(irradiance({DirectionalLight{{3, 0, -4}}, 3}), 0.8 * 3 / (pi * radius * radius));
    check(irradiance({EnvironmentLight{}, 3}), 2 * pi * 3 / (4 * pi * pi * radius * radius));  // on both sides
    // A disc-like square of side 0.02 at height 2: nearly a point of area A, E = L A / r².
    check(irradiance({AreaLight{{0.09, 0.04, 2}, {0, 0.02, 0}, {0.02, 0, 0}}, 3}), 3 / pi / 4, 1e-4);
    check(irradiance({AreaLight{{0.09, 0.04, 2}, {0.02, 0, 0}, {0, 0.02, 0}}, 3}), 0);  // it shines upwards
  }

  TEST_CASE("the furnace: 2π everywhere, also near edges and in corners, without variance between walls") {
    const Scene scene = open_scene({.name = "@furnace", .samples = {}});
    std::vector<Sample> samples;
    add_by_area(samples, scene.mesh, 200, 3);
    samples.push_back({{1e-6, 0, 1e-6}, {0, 1, 0}});
    const Mean mean = backward(scene, samples, 64 * 8);
    CHECK(std::abs(mean.value - 2 * pi) < 4 * mean.error);
    CHECK(mean.error < 0.01 * 2 * pi);
    const Mean front = backward(scene, samples, 64 * 8, true);
    CHECK(std::abs(front.value - 2 * pi) < 4 * front.error);
  }

  TEST_CASE("the furnace at vertices, in corners too, and beside its walls by a rounding error: 2π") {
    const Scene scene = open_scene({.name = "@furnace", .samples = {}});
    const std::size_t step = scene.samples.size() / 200 + 1;
    std::vector<Sample> corners;
    for (const Sample& sample : scene.samples)
      if (corners.size() < 24 && std::ranges::all_of(std::array{0, 1, 2}, [&](int axis) {
            return sample.position[axis] == scene.box.low[axis] || sample.position[axis] == scene.box.high[axis];
          }))
        corners.push_back(sample);
    REQUIRE(corners.size() == 24);
    std::vector<Sample> vertices;
    for (std::size_t i = 0; i < scene.samples.size(); i += step) vertices.push_back(scene.samples[i]);
    std::vector<Sample> beside;
    for (const double off : {1e-8, -1e-8}) beside.push_back({{0.3, off, 0.6}, {0, 1, 0}});
    for (const auto& samples : {corners, vertices, beside}) {
      const Mean mean = backward(scene, samples, 64 * 16);
      CHECK(std::abs(mean.value - 2 * pi) < 4 * mean.error);
      CHECK(mean.error < 0.03 * 2 * pi);
    }
  }

  TEST_CASE("the sunlit floor: 1 everywhere, by backward paths and by photons; without the cosine it is refuted") {
    const Scene scene = open_scene({.name = "@sunlit", .samples = {}});
    std::vector<Sample> samples;
    add_by_area(samples, scene.mesh, 200, 3);
    const Mean mean = backward(scene, samples, 64);
    CHECK(mean.value == doctest::Approx(1).epsilon(1e-6));  // seen directly: no variance
    std::vector<Disc> discs;
    for (int x = 0; x < 6; ++x)
      for (int z = 0; z < 6; ++z) discs.push_back({{0.2 + 0.12 * x, 0, 0.2 + 0.12 * z}, {0, 1, 0}, 0.05});
    std::vector<double> runs;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      const Paths paths = photon_paths(scene, 50'000, seed);
      const Outcome outcome =
          run(make_problem(paths, discs), Candidate{Technique::brute_force, BruteForceParameters{}});
      double sum = 0;
      for (const double one : outcome.irradiance) sum += one / static_cast<double>(discs.size());
      runs.push_back(sum);
    }
    double average = 0;
    for (const double one : runs) average += one / 16;
    double squares = 0;
    for (const double one : runs) squares += (one - average) * (one - average) / (16 * 15);
    CHECK(std::abs(average - 1) < 4 * std::sqrt(squares));
    CHECK(std::abs(average - 1 / 0.8) > 8 * std::sqrt(squares));
  }

  TEST_CASE("negative control: with an albedo of 0.55 instead of 0.5 the furnace is refuted") {
    Scene scene = open_scene({.name = "@furnace", .samples = {}});
    scene.mesh.materials.all[0].diffuse = 0.55;
    std::vector<Sample> samples;
    add_by_area(samples, scene.mesh, 200, 3);
    const Mean mean = backward(scene, samples, 64 * 8);
    CHECK(std::abs(mean.value - 2 * pi) > 8 * mean.error);
    CHECK(std::abs(mean.value - pi / 0.45) < 4 * mean.error);
  }

  TEST_CASE("a mirror in uniform light changes nothing") {
    Scene scene = open_scene({.name = "@furnace", .samples = {}});
    Mesh shell;  // a square
    shell.positions = {{0.3, 0.4, 0.3}, {0.7, 0.4, 0.3}, {0.7, 0.4, 0.7}, {0.3, 0.4, 0.7}};
    const auto first = static_cast<std::uint32_t>(scene.mesh.positions.size());
    for (const glm::dvec3& corner : shell.positions) {
      scene.mesh.positions.push_back(corner);
      scene.mesh.normals.emplace_back(0, 1, 0);
    }
    for (const auto& [a, b, c] : {std::array{0U, 1U, 2U}, std::array{0U, 2U, 3U}})
      scene.mesh.triangles.push_back({first + a, first + b, first + c});
    scene.mesh.materials.all.push_back({.name = "mirror", .diffuse = 0, .specular = 1});
    scene.mesh.materials.of_triangle.resize(scene.mesh.triangles.size(), 1);
    std::vector<Sample> samples;
    add_by_area(samples, scene.mesh, 200, 3);
    std::erase_if(samples, [](const Sample& sample) { return sample.position.y == 0.4; });
    const Mean mean = backward(scene, samples, 64 * 8);
    CHECK(std::abs(mean.value - 2 * pi) < 4 * mean.error);
  }
}

TEST_SUITE("backward paths and photons") {
  TEST_CASE("photons land on the surfaces with the flux that backward paths find there" * doctest::test_suite("long")) {
    for (const char* name : {"@cornell", "@tree-coarse", "@furnace"}) {
      CAPTURE(name);
      const Scene scene = open_scene({.name = name, .samples = {}});
      CHECK_FALSE(misses_light(scene));
      std::vector<Sample> samples;
      add_by_area(samples, scene.mesh, 3000, 5);
      const Mean mean = backward(scene, samples, 64);
      // The mean irradiance of samples by area, times the area, is the flux that lands on the surfaces.
      double area = 0;
      for (const auto& [a, b, c] : scene.mesh.triangles)
        area += 0.5 * glm::length(glm::cross(scene.mesh.positions[b] - scene.mesh.positions[a],
                                             scene.mesh.positions[c] - scene.mesh.positions[a]));
      const Paths paths = photon_paths(scene, 100'000, 2);
      double landed = 0;
      double squares = 0;
      double open = 0;
      std::uint64_t photon = 0;
      for (std::size_t i = 0; i < paths.rays.size(); ++i) {
        if (paths.photons[i] != photon) {
          squares += open * open;
          open = 0;
          photon = paths.photons[i];
        }
        if (paths.landings[i] < unbounded) open += paths.rays[i].power;
        if (paths.landings[i] < unbounded) landed += paths.rays[i].power;
      }
      const double error_of_photons = std::sqrt(squares);
      // Samples are random places: their spread counts, too.
      const double spread = 0.02 * mean.value * area;
      CHECK(std::abs(mean.value * area - landed) < 4 * (mean.error * area + error_of_photons) + spread);
    }
  }

  TEST_CASE("light by way of mirrors and glass from points, spots and the sun is not found, and this is known") {
    CHECK(misses_light(open_scene({.name = "@caustic", .samples = {}})));
    CHECK(misses_light(open_scene({.name = "@interior", .samples = {}})));
    CHECK_FALSE(misses_light(open_scene({.name = "@courtyard", .samples = {}})));
  }

  TEST_CASE("paths do not depend on threads or on rounds; a stop leaves whole rounds") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    std::vector<Sample> samples;
    add_by_area(samples, scene.mesh, 50, 5);
    const BackwardPaths walk(scene, 7);
    std::vector<PathSums> once(samples.size());
    std::vector<PathSums> twice(samples.size());
    add_backward_paths(walk, samples, 192, false, once);
    add_backward_paths(walk, samples, 64, false, twice);
    add_backward_paths(walk, samples, 192, false, twice);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      CHECK(once[i].irradiance() == twice[i].irradiance());
      CHECK(once[i].paths == 192);
    }
    std::stop_source source;
    source.request_stop();
    std::vector<PathSums> none(samples.size());
    add_backward_paths(walk, samples, 64, false, none, source.get_token());
    CHECK(none[0].paths == 0);
  }
}

}  // namespace detp::sim
