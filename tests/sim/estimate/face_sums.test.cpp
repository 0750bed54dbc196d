#include "detp/sim/estimate/face_sums.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "detp/sim/open/open_scene.hpp"
#include "detp/sim/photons/photon_paths.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// A square of side 2 in two triangles, and a triangle of area 1/2 beside it, in two groups and two materials.
Mesh three_triangles() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  mesh.materials.all = {{.name = "grey"}, {.name = "white"}};
  mesh.materials.of_triangle = {0, 0, 1};
  mesh.groups = {{"floor", "all", "unused"}, {{0, 1}, {1}}, {0, 0, 1}};
  return mesh;
}

/// A photon lands on each side of the square and twice on the triangle beside it; one lands nowhere.
Paths some_paths() {
  Paths paths;
  const auto add = [&](double z, double power, std::uint64_t photon, std::uint32_t triangle) {
    paths.rays.push_back({{0.5, 0.2, z}, {0, 0, z > 0 ? -1.0 : 1.0}, 1, power});
    paths.photons.push_back(photon);
    paths.triangles.push_back(triangle);
  };
  add(1, 1, 0, 0);
  add(-1, 2, 1, 1);
  add(1, 3, 2, 2);
  add(1, 0.5, 2, 2);
  add(1, 7, 3, no_triangle);
  paths.photon_count = 5;
  return paths;
}

}  // namespace

TEST_SUITE("light on faces") {
  TEST_CASE("parts of the surface: their names and areas") {
    const Mesh mesh = three_triangles();
    CHECK(parts_by_triangle(mesh).areas == std::vector<double>{2, 2, 0.5});
    const SurfaceParts materials = parts_by_material(mesh);
    CHECK(materials.names == std::vector<std::string>{"grey", "white"});
    CHECK(materials.areas == std::vector<double>{4, 0.5});
    const SurfaceParts groups = parts_by_group(mesh);
    CHECK(groups.names == std::vector<std::string>{"floor", "all"});
    CHECK(groups.areas == std::vector<double>{4, 4.5});
    CHECK(parts_by_group({}).areas.empty());
  }

  TEST_CASE("photons that land add up on their triangle, material and groups, with errors of photons") {
    const Mesh mesh = three_triangles();
    Paths paths = some_paths();
    for (const double power : {1.0, 2.0, 3.0, 0.5, 7.0}) paths.further.push_back(2 * power);
    paths.further_bands = 1;
    const RunOptions errors{.standard_error = true};
    const Outcome faces = sums_of_parts(paths, mesh, parts_by_triangle(mesh), false, errors);
    CHECK(faces.hits == std::vector<std::uint64_t>{1, 1, 2});
    CHECK(faces.total_hits == 4);
    const std::vector<double> expected{0.5, 1, 7};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(faces.irradiance[i] == doctest::Approx(expected[i]).epsilon(1e-14));
      CHECK(faces.further[0].irradiance[i] == doctest::Approx(2 * expected[i]).epsilon(1e-14));
    }
    CHECK(faces.standard_error[2] == unbounded);  // one photon, twice
    CHECK(faces.upper_bound[2] > 7);
    const Outcome groups = sums_of_parts(paths, mesh, parts_by_group(mesh), false, errors);
    CHECK(groups.irradiance[1] == doctest::Approx(6.5 / 4.5).epsilon(1e-14));
    // Σ x² of the photons that bring 1, 2 and 3.5, of five
    CHECK(groups.standard_error[1] ==
          doctest::Approx(std::sqrt(5 / 4.0 * (17.25 - 6.5 * 6.5 / 5)) / 4.5).epsilon(1e-12));
    const Outcome front = sums_of_parts(paths, mesh, parts_by_triangle(mesh), true, {});
    CHECK(front.hits == std::vector<std::uint64_t>{1, 0, 2});
    CHECK(front.irradiance[1] == 0);
  }

  TEST_CASE("in a closed room of known irradiance every wall has it") {
    const Scene scene = open_scene({.name = "@furnace", .samples = {}});
    const TracedPaths paths = photon_paths(scene, 100'000, 7);
    const SurfaceParts materials = parts_by_material(scene.mesh);
    const Outcome found = sums_of_parts(paths, scene.mesh, materials, false, {.standard_error = true});
    REQUIRE(scene.known_irradiance);
    for (std::size_t part = 0; part < materials.areas.size(); ++part) {
      if (materials.areas[part] == 0) continue;
      CHECK(std::abs(found.irradiance[part] - *scene.known_irradiance) < 4 * found.standard_error[part]);
      CHECK(found.standard_error[part] < 0.01 * found.irradiance[part]);
    }
    const Outcome faces =
        sums_of_parts(paths, scene.mesh, parts_by_triangle(scene.mesh), false, {.standard_error = true});
    std::size_t near = 0;
    for (std::size_t face = 0; face < faces.hits.size(); ++face)
      near += std::abs(faces.irradiance[face] - *scene.known_irradiance) < 2.5 * faces.standard_error[face] ? 1 : 0;
    CHECK(static_cast<double>(near) > 0.95 * static_cast<double>(faces.hits.size()));
  }

  TEST_CASE("rays that do not know their triangles are refused") {
    Paths paths = some_paths();
    paths.triangles.clear();
    CHECK_THROWS_AS((void)sums_of_parts(paths, three_triangles(), {}, false, {}), std::invalid_argument);
  }
}
