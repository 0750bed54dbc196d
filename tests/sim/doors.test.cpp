#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "detp/sim/rays/ray_source.hpp"
#include "detp/sim/scene/mesh.hpp"
#include "detp/sim/technique/streamed.hpp"
#include "support/candidates.hpp"
#include "support/not_a_length.hpp"

// Public functions of sim that take numbers. Each returns a finite result, or throws std::invalid_argument with a
// message that says which quantity is wrong.

using namespace detp;
using namespace detp::sim;
using detp::support::infinity;
using detp::support::not_a_number;

namespace {

constexpr double denormal = std::numeric_limits<double>::denorm_min();
const std::vector<double> numbers{not_a_number,
                                  infinity,
                                  -infinity,
                                  -1.0,
                                  -1e300,
                                  -denormal,
                                  0.0,
                                  -0.0,
                                  denormal,
                                  1e-310,
                                  1e-160,
                                  1e-100,
                                  1e-12,
                                  1.0,
                                  1e90,
                                  1e100,
                                  1e155,
                                  1e300,
                                  std::numeric_limits<double>::max()};

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(const Ray& ray) { return finite(ray.origin) && finite(ray.direction) && glm::length(ray.direction) > 0.9; }
bool finite(const Disc& disc) { return finite(disc.centre) && finite(disc.normal) && std::isfinite(disc.radius); }

template <class Item>
bool all_finite(const std::vector<Item>& items) {
  for (const Item& item : items)
    if (!finite(item)) return false;
  return !items.empty();
}

struct Door {
  const char* name;
  const char* complaint;
  std::function<bool(double)> open;  ///< true if the result is valid
};

Scene lit_scene() {
  Scene scene;
  scene.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.mesh.triangles = {{0, 1, 2}};
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.lights = {{PointLight{{0.2, 0.2, 1}}}};
  return scene;
}

const std::vector<Door>& doors() {
  static const std::vector<Door> list{
      {"line field, radius", "sphere radius",
       [](double x) {
         return all_finite(LineField({{}, x}, 1).lines(0, 9));
       }},
      {"line field, centre", "sphere centre",
       [](double x) {
         return all_finite(LineField({{0, x, 0}, 1}, 1).lines(0, 9));
       }},
      {"uniform discs, side", "cube side", [](double x) { return all_finite(uniform_discs(Body::cube, x, 9, 1, 1)); }},
      {"uniform discs, radius", "disc radius",
       [](double x) { return all_finite(uniform_discs(Body::cube_faces, 1, 9, x, 1)); }},
      {"problem without rays", "farthest",
       [](double x) {
         const std::vector<Disc> discs(1);
         const double slack = make_problem_without_rays(discs, x).slack();
         return slack > 0 && slack < infinity;
       }},
      {"photon paths, albedo", "albedo",
       [](double x) {
         Scene scene = lit_scene();
         scene.mesh.materials.all = {{.diffuse = x}};
         return all_finite(photon_paths(scene, 9, 1).rays);
       }},
      {"photon paths, light", "light", [](double x) {
         Scene scene = lit_scene();
         scene.lights = {{PointLight{{0.2, x, 1}}}};
         return all_finite(photon_paths(scene, 9, 1).rays);
       }}};
  return list;
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("no function of sim accepts a number that makes its result infinite or NaN") {
    for (const Door& door : doors())
      for (const double number : numbers) {
        INFO("std::string(door.name) ", std::string(door.name), ", number ", number);
        try {
          const bool sound = door.open(number);
          CHECK(sound);
          CHECK(std::isfinite(number));
        } catch (const std::invalid_argument& error) {
          const std::string message = error.what();
          const bool named = message.find(door.complaint) != std::string::npos ||
                             message.find("1e100") != std::string::npos || message.find("photons") != std::string::npos;
          CHECK_MESSAGE(named, message);
          CHECK(number != 1.0);
        }
      }
  }

  TEST_CASE("streams refuse the rays that make_problem refuses, with the ray's number in the source") {
    const auto discs = uniform_discs(Body::cube, 2, 10, 0.1, 1);
    std::vector<Ray> rays(100);
    rays[57].length = -infinity;
    for (const std::size_t block : {0, 1, 7, 100})
      CHECK_THROWS_WITH_AS(
          (void)run_streamed(discs, RaysInMemory(rays), {Technique::brute_force, BruteForceParameters{}},
                             {.run = {}, .block = block}),
          "ray 57: length must be > 0 and finite (got -inf)", std::invalid_argument);
  }

  TEST_CASE("numbers of threads out of range are refused by every function that takes one") {
    const std::vector<Disc> discs(1);
    const std::vector<Ray> rays(1);
    Problem problem = make_problem(rays, discs);
    for (const int threads : {-1, 4097, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
      CHECK_THROWS_WITH_AS((void)make_problem(rays, discs, false, threads), doctest::Contains("number of threads"),
                           std::invalid_argument);
      CHECK_THROWS_WITH_AS(set_rays(problem, rays, threads), doctest::Contains("number of threads"),
                           std::invalid_argument);
      for (const Candidate& candidate : support::exact_candidates())
        CHECK_THROWS_WITH_AS((void)run(problem, candidate, {.threads = threads}),
                             doctest::Contains("number of threads"), std::invalid_argument);
    }
  }

  TEST_CASE("more discs than fit in memory are refused before any is made") {
    CHECK_THROWS_WITH_AS((void)uniform_discs(Body::cube, 1, std::size_t{1} << 60, 1, 1), doctest::Contains("GB"),
                         std::length_error);
  }
}
