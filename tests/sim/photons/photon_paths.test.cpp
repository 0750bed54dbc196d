#include "detp/sim/photons/photon_paths.hpp"
#include "detp/sim/open/open_scene.hpp"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "detp/sim/files/file_error.hpp"
#include "detp/sim/photons/photon_walk.hpp"
#include "detp/sim/scene/built_in/mesh_pieces.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;

namespace {

/// A closed box of side 2 · `scale` around `centre`, with a lamp in its middle.
Scene closed_box(double scale = 1, const glm::dvec3& centre = glm::dvec3{0.0}) {
  Scene scene;
  scene.name = "closed box";
  built_in::add_box(scene.mesh, centre - scale * glm::dvec3{1.0},
                    {{{2 * scale, 0, 0}, {0, 2 * scale, 0}, {0, 0, 2 * scale}}}, 0.25 * scale);
  for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
  scene.lights = {{PointLight{.position = centre}}};
  return scene;
}

double diagonal(const Scene& scene) { return glm::length(scene.box.size()); }

glm::dvec3 end_of(const Ray& ray) { return ray.origin + ray.length * ray.direction; }

bool same(const std::vector<Ray>& first, const std::vector<Ray>& second) {
  return std::ranges::equal(first, second, [](const Ray& a, const Ray& b) {
    return a.origin == b.origin && a.direction == b.direction && a.length == b.length && a.power == b.power;
  });
}

std::vector<Ray> paths_with_threads(const Scene& scene, std::size_t count, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return photon_paths(scene, count, 1).rays;
}

/// Checks that all rays are valid.
void check_sound(const Scene& scene, const std::vector<Ray>& rays) {
  const double longest = 2 * (1 + 2e-5) * diagonal(scene);
  std::size_t unsound = 0;
  for (const Ray& ray : rays) {
    const bool finite = std::isfinite(glm::length((ray.origin - scene.box.centre()) / diagonal(scene)));
    const bool length = ray.length > 0 && ray.length <= longest;
    const bool unit = std::abs(glm::length(ray.direction) - 1) < 1e-12;
    if (!finite || !length || !unit || !(ray.power > 0)) ++unsound;
  }
  CHECK(unsound == 0);
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("there are `count` rays and those up to the end of the last photon, all valid, and power × photons = 1" *
            doctest::test_suite("long")) {
    for (const char* name : {"@tree", "@tree-coarse", "@courtyard", "@cornell", "@caustic", "@interior"}) {
      CAPTURE(name);
      const Scene scene = open_scene({.name = name, .samples = {}});
      for (const std::size_t count : {0U, 1U, 1000U}) {
        const Paths paths = photon_paths(scene, count, 1);
        const std::vector<Ray>& rays = paths.rays;
        REQUIRE(paths.photons.size() == rays.size());
        REQUIRE(paths.landings.size() == rays.size());
        if (count == 0) CHECK(rays.empty());
        if (count == 0) continue;
        REQUIRE(rays.size() >= count);
        CHECK(std::ranges::is_sorted(paths.photons));
        CHECK(paths.photons.back() == paths.photons[count - 1]);
        CHECK(paths.photon_count == paths.photons.back() + 1);
        const Paths more = photon_paths(scene, rays.size() + 1, 1);
        CHECK(more.photons[rays.size()] > paths.photons.back());
        check_sound(scene, rays);
        if (scene.lights.size() > 1) continue;
        const double photons = 1 / rays[0].power;
        CHECK(photons == doctest::Approx(std::round(photons)).epsilon(1e-12));
        CHECK(photons >= 1);
      }
    }
  }

  TEST_CASE("all powers add up to the flux of the lights, each photon counted once") {
    for (const char* name : {"@cornell", "@caustic", "@interior"}) {
      CAPTURE(name);
      const Scene scene = open_scene({.name = name, .samples = {}});
      Scene dark = scene;  // every photon has one piece
      dark.mesh.materials = {.all = {{.diffuse = 0}}};
      double sum = 0;
      for (const Ray& ray : photon_paths(dark, 50'000, 1).rays) sum += ray.power;
      CHECK(sum == doctest::Approx(1).epsilon(1e-3));
    }
  }

  TEST_CASE("a dim lamp among bright ones gets 0.9 of its share of photons + a tenth of an even share") {
    Scene scene = open_scene({.name = "@caustic", .samples = {}});
    scene.mesh.materials = {.all = {{.diffuse = 0}}};
    const auto& spot = std::get<SpotLight>(scene.lights.at(0).shape);
    double photons = 0;
    for (const Ray& ray : photon_paths(scene, 50'000, 1).rays)
      if (glm::distance(ray.origin, spot.position) < 1e-3) ++photons;
    CHECK(photons / 50'000 == doctest::Approx(0.9 * 0.05 + 0.1 / 3).epsilon(0.01));
  }

  TEST_CASE("a smaller number of rays gives the first of a larger number, except for their power") {
    const Scene scene = open_scene({.name = "@cornell", .samples = {}});
    const std::vector<Ray> few = photon_paths(scene, 500, 7).rays;
    const std::vector<Ray> many = photon_paths(scene, 5000, 7).rays;
    for (std::size_t i = 0; i < few.size(); ++i) {
      CHECK(few[i].origin == many[i].origin);
      CHECK(few[i].length == many[i].length);
    }
  }

  TEST_CASE("in a closed box segments start a gap after a wall and end a gap beyond one, at any scale and place") {
    for (const double scale : {1e-13, 1.0, 1e12})
      for (const double offset : {0.0, 5e6}) {
        INFO("scale ", scale, ", offset ", offset);
        const glm::dvec3 centre = offset * scale * glm::dvec3{1, -1, 0.5};
        const Scene scene = closed_box(scale, centre);
        const double gap = 1e-5 * std::sqrt(12.0);
        const double rounding = 1e-15 * offset + 1e-14;
        std::size_t off = 0;
        for (const Ray& ray : photon_paths(scene, 5000, 3).rays) {
          const glm::dvec3 landing = (end_of(ray) - centre) / scale - gap * ray.direction;
          const glm::dvec3 start = (ray.origin - centre) / scale - gap * ray.direction;
          const auto out = [](const glm::dvec3& p) {
            return std::max(std::max(std::abs(p.x), std::abs(p.y)), std::abs(p.z));
          };
          const bool lands = std::abs(out(landing) - 1) <= 4 * rounding;
          const bool starts = std::abs(out(start) - 1) <= 4 * rounding || glm::length(start) <= 4 * rounding;
          const bool short_piece = ray.length < 2 * gap * scale;
          if (!lands || (!starts && !short_piece)) ++off;
        }
        CHECK(off == 0);
      }
  }

  TEST_CASE("a photon lands on the surface, whether its ray goes on or not, and nowhere if it leaves the scene") {
    for (const double overshoot : {0.0, 0.3}) {
      Scene scene = closed_box();
      scene.overshoot = overshoot;
      const Paths paths = photon_paths(scene, 5000, 3);
      for (std::size_t i = 0; i < paths.rays.size(); ++i) {
        const glm::dvec3 place = paths.rays[i].origin + paths.landings[i] * paths.rays[i].direction;
        const double outermost = std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
        REQUIRE(outermost == doctest::Approx(1).epsilon(1e-13));
        REQUIRE(paths.landings[i] < paths.rays[i].length);
      }
    }
    Scene open;
    built_in::add_quad(open.mesh, {{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}}, 1);
    for (const glm::dvec3& position : open.mesh.positions) open.box.include(position);
    open.lights = {{PointLight{.position = {0, 0.5, 0}}}};
    const Paths paths = photon_paths(open, 2000, 1);
    CHECK(std::ranges::count_if(paths.landings, [](double landing) { return landing == unbounded; }) > 1000);
  }

  TEST_CASE("a photon that leaves the scene ends on the sphere of twice the half diagonal") {
    Scene scene;
    built_in::add_quad(scene.mesh, {{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}}, 1);
    for (const glm::dvec3& position : scene.mesh.positions) scene.box.include(position);
    scene.lights = {{PointLight{.position = {0, 0.5, 0}}}};
    scene.mesh.materials.all = {{.diffuse = 0}};
    std::size_t away = 0;
    for (const Ray& ray : photon_paths(scene, 2000, 1).rays) {
      const double radius = glm::length(end_of(ray));
      const bool on_plane = std::abs(end_of(ray).y) < 1e-4 && radius < 1.5;
      if (!on_plane) CHECK(radius == doctest::Approx(std::sqrt(8.0)).epsilon(1e-12));
      if (!on_plane) ++away;
    }
    CHECK(away > 1000);
    CHECK(away < 2000);
  }

  TEST_CASE("with albedo 1 paths in a closed box terminate: a photon has a limited number of pieces") {
    Scene scene = closed_box();
    scene.mesh.materials.all = {{.diffuse = 1}};
    const TracedPaths paths = photon_paths(scene, PhotonWalk::most_pieces + 1, 1);
    CHECK(paths.rays.size() == 2 * PhotonWalk::most_pieces);
    CHECK(paths.light.photons[static_cast<std::size_t>(PathEnd::cut)] == 2);
  }

  TEST_CASE("with albedo 0 every photon in a closed box has one segment") {
    Scene scene = closed_box();
    scene.mesh.materials.all = {{.diffuse = 0}};
    CHECK(1 / photon_paths(scene, 1000, 1).rays[0].power == doctest::Approx(1000));
  }
}

TEST_SUITE("identity") {
  TEST_CASE("paths do not depend on the number of threads") {
    for (const char* name : {"@tree", "@cornell"}) {
      const Scene scene = open_scene({.name = name, .samples = {}});
      CHECK(same(paths_with_threads(scene, 20'000, 1), paths_with_threads(scene, 20'000, 2)));
    }
  }

  TEST_CASE("another seed gives other paths") {
    const Scene scene = closed_box();
    CHECK(same(photon_paths(scene, 10, 1).rays, photon_paths(scene, 10, 1).rays));
    CHECK_FALSE(same(photon_paths(scene, 10, 1).rays, photon_paths(scene, 10, 2).rays));
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("in a closed box a photon has 1 / (1 - albedo) segments on average") {
    constexpr double count = 200'000;
    for (const double albedo : {0.2, 0.5, 0.8}) {
      Scene scene = closed_box();
      scene.mesh.materials.all = {{.diffuse = albedo}};
      const double photons = 1 / photon_paths(scene, static_cast<std::size_t>(count), 5).rays[0].power;
      const double expected = 1 / (1 - albedo);
      const double error = std::sqrt(albedo) / (1 - albedo) / std::sqrt(photons);  // of a geometric distribution
      CAPTURE(albedo);
      CHECK(std::abs(count / photons - expected) < 5 * error);
      CHECK_MESSAGE(std::abs(count / photons - 1.05 * expected) > 5 * error, "negative control: 5 % off must not pass");
    }
  }

  TEST_CASE("photons leave a wall into the room, distributed by the cosine law") {
    const Scene scene = closed_box();
    double sum = 0;
    double bounced = 0;
    for (const Ray& ray : photon_paths(scene, 200'000, 9).rays) {
      if (std::abs(ray.origin.y + 1) > 3.5e-5) continue;  // starts on the floor
      sum += ray.direction.y;
      ++bounced;
    }
    const double error = std::sqrt(1.0 / 18) / std::sqrt(bounced);
    CHECK(bounced > 10'000);
    CHECK(std::abs(sum / bounced - 2.0 / 3) < 5 * error);
    CHECK_MESSAGE(std::abs(sum / bounced - 1.05 * 2 / 3) > 5 * error, "negative control: 5 % off must not pass");
  }

  TEST_CASE("a lamp in the middle of a cube lights its six faces equally") {
    Scene scene = closed_box();
    scene.mesh.materials.all = {{.diffuse = 0}};
    constexpr double count = 60'000;
    glm::dvec3 low{0.0}, high{0.0};
    for (const Ray& ray : photon_paths(scene, static_cast<std::size_t>(count), 4).rays)
      for (int axis = 0; axis < 3; ++axis) {
        if (end_of(ray)[axis] < -1) ++low[axis];
        if (end_of(ray)[axis] > 1) ++high[axis];
      }
    const double error = std::sqrt(count * 5 / 36);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::abs(low[axis] - count / 6) < 5 * error);
      CHECK(std::abs(high[axis] - count / 6) < 5 * error);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a scene without light, triangles or box is refused by name") {
    CHECK_THROWS_WITH_AS((void)photon_paths(open_scene({.name = "@uniform", .samples = 10}), 1, 1),
                         "photon paths need a light; @uniform has none", std::invalid_argument);
    Scene empty;
    empty.name = "empty";
    empty.lights = {{PointLight{}}};
    CHECK_THROWS_WITH_AS((void)photon_paths(empty, 1, 1), "photon paths need triangles; empty has none",
                         std::invalid_argument);
    Scene boxless = closed_box();
    boxless.box = Box{};
    CHECK_THROWS_WITH_AS((void)photon_paths(boxless, 1, 1), doctest::Contains("the scene's box"),
                         std::invalid_argument);
    boxless.box = Box{glm::dvec3{1.0}, glm::dvec3{1.0}};
    CHECK_THROWS_WITH_AS((void)photon_paths(boxless, 1, 1), doctest::Contains("diagonal of the scene's box"),
                         std::invalid_argument);
  }

  TEST_CASE("an albedo outside [0, 1] and an invalid light are refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double albedo : {-0.1, 1.1, nan}) {
      Scene scene = closed_box();
      scene.mesh.materials.all = {{.diffuse = albedo}};
      CHECK_THROWS_WITH_AS((void)photon_paths(scene, 1, 1), doctest::Contains("albedo must be in [0, 1]"),
                           std::invalid_argument);
    }
    Scene scene = closed_box();
    scene.lights = {{AreaLight{.corner = {}, .edge_u = {1, 0, 0}, .edge_v = {2, 0, 0}}}};
    CHECK_THROWS_WITH_AS((void)photon_paths(scene, 1, 1), doctest::Contains("area light has no area"),
                         std::invalid_argument);
    scene.lights = {{PointLight{.position = {0, nan, 0}}}};
    CHECK_THROWS_WITH_AS((void)photon_paths(scene, 1, 1), doctest::Contains("point light must be finite"),
                         std::invalid_argument);
  }

  TEST_CASE("tracing gives up after the stated number of photons if the light meets no surface") {
    Scene scene = closed_box();
    // shines up, far above the scene
    scene.lights = {{AreaLight{.corner = {0, 50, 0}, .edge_u = {0, 0, 1}, .edge_v = {1, 0, 0}}}};
    CHECK_THROWS_WITH_AS((void)photon_paths(scene, 100, 1), doctest::Contains("11000 photons gave 0 pieces"),
                         std::invalid_argument);
  }
}

TEST_SUITE("known answer") {
  TEST_CASE("light of all kinds is valid in pathological meshes, or a clear error" * doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    std::size_t traced = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder + "/pathological")) {
      const std::string path = entry.path().string();
      CAPTURE(path);
      for (const LightKind kind :
           {LightKind::area, LightKind::point, LightKind::spot, LightKind::directional, LightKind::environment})
        for (const auto& [name_of_up, up] : named_ups) {
          const std::string_view known = name_of_up;  // clang 14 cannot capture a binding
          CAPTURE(known);
          try {
            Scene scene = open_scene({.name = path, .samples = {}, .lights = {kind}, .up = up});
            scene.overshoot = 0.1 * diagonal(scene);
            check_sound(scene, photon_paths(scene, 300, 1).rays);
            ++traced;
          } catch (const FileError&) {
            CHECK((path.ends_with("no_faces.obj") || path.ends_with("nonfinite_vertices.obj")));
          } catch (const std::invalid_argument& error) {
            CHECK(std::string(error.what()).find("hardly meets") != std::string::npos);
          }
        }
    }
    CHECK(traced > 200);
  }

  TEST_CASE("every test scene that can be read gives valid paths" * doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string path = entry.path().string();
      if (!path.ends_with(".obj") && !path.ends_with(".ply")) continue;
      CAPTURE(path);
      try {
        const Scene scene = open_scene({.name = path, .samples = {}});
        const std::vector<Ray> rays = photon_paths(scene, 10'000, 1).rays;
        CHECK(rays.size() >= 10'000);
        check_sound(scene, rays);
      } catch (const FileError&) {
        CHECK((path.ends_with("no_faces.obj") || path.ends_with("nonfinite_vertices.obj")));
      }
    }
  }
}
