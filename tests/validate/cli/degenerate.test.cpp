#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "support/command.hpp"

namespace detp::support {
namespace {

struct File {
  std::string name;
  std::string path;
};

/// Writes discs in a cube of side 2 around the origin, changed one by one.
File disc_file(const ScratchFolder& folder, const std::string& name, const std::function<void(sim::Disc&)>& change,
               std::size_t count = 300) {
  auto discs = sim::uniform_discs(sim::Body::cube, 2, count, 0.01, 1);
  for (sim::Disc& disc : discs) change(disc);
  const std::string path = folder.path(name + ".csv");
  sim::write_discs(path, discs);
  return {name, path};
}

std::vector<File> disc_files(const ScratchFolder& folder) {
  return {disc_file(folder, "point",
                    [](sim::Disc& disc) {
                      disc.centre = {1, 2, 3};
                    }),
          disc_file(folder, "line", [](sim::Disc& disc) { disc.centre.y = disc.centre.z = 0; }),
          disc_file(folder, "plane", [](sim::Disc& disc) { disc.centre.z = 0; }),
          disc_file(
              folder, "one", [](sim::Disc&) {}, 1),
          disc_file(folder, "far", [](sim::Disc& disc) { disc.centre += 1e6; }),
          disc_file(folder, "large", [](sim::Disc& disc) { disc.radius = 1e6; }),
          disc_file(folder, "small", [](sim::Disc& disc) { disc.radius = 1e-9; }),
          disc_file(folder, "cube", [](sim::Disc&) {})};
}

/// Writes segments through the cube, changed one by one.
File ray_file(const ScratchFolder& folder, const std::string& name, const std::function<void(sim::Ray&)>& change,
              std::size_t count = 300) {
  auto rays = sim::LineField({{0, 0, 0}, 2}, 1).lines(0, count);
  for (sim::Ray& ray : rays) {
    ray.length = 1;
    change(ray);
  }
  const std::string path = folder.path("rays_" + name + ".csv");
  sim::write_rays(path, rays);
  return {name, path};
}

std::vector<File> ray_files(const ScratchFolder& folder) {
  return {ray_file(folder, "segments", [](sim::Ray&) {}),
          ray_file(
              folder, "one segment", [](sim::Ray&) {}, 1),
          ray_file(folder, "parallel lines",
                   [](sim::Ray& ray) {
                     ray.direction = {0, 0, 1};
                     ray.length = sim::unbounded;
                   }),
          ray_file(folder, "outside", [](sim::Ray& ray) { ray.origin.x += 50; })};
}

/// Numbers that are not finite become null in JSON.
bool has_null(const Json& json) {
  if (json.is_null()) return true;
  if (!json.is_structured()) return false;
  return std::any_of(json.begin(), json.end(), has_null);
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("scene and choose answer in finite numbers for degenerate rays and discs") {
    const ScratchFolder folder;
    const auto rays = ray_files(folder);
    for (const File& discs : disc_files(folder))
      for (const File& some : rays) {
        CAPTURE(discs.name);
        CAPTURE(some.name);
        const Arguments files{"--discs", discs.path, "--ray-file", some.path, "--format", "json", "--quiet"};
        const Finished scene = detp(Arguments{"scene", "--effects", "all"} + files);
        CHECK(scene.code == 0);
        CHECK_FALSE(has_null(scene.json().at("effects")));
        const Finished choice = detp(Arguments{"choose", "--rigor", "estimate"} + files);
        CHECK(choice.code == 0);
        const Json chosen = choice.json().at("choice");
        CHECK_FALSE(has_null(chosen));
        CHECK(chosen.at("predicted_seconds") > 0);
        CHECK(chosen.at("predicted_seconds") < 1);
      }
  }

  TEST_CASE("segments that stay outside the scene are predicted to hit next to nothing") {
    const ScratchFolder folder;
    const File discs = disc_file(
        folder, "discs", [](sim::Disc& disc) { disc.radius = 0.1; }, 3000);
    const auto predicted_hits = [&](double shift) {
      const File rays = ray_file(
          folder, "rays", [&](sim::Ray& ray) { ray.origin.x += shift; }, 3000);
      const Finished choice = detp({"choose", "--rigor", "estimate", "--discs", discs.path, "--ray-file", rays.path,
                                    "--format", "json", "--quiet"});
      REQUIRE(choice.code == 0);
      const double hits = choice.json().at("candidates").at(0).at("predicted").at("hits");
      return hits;
    };
    const double inside = predicted_hits(0);
    CHECK(inside > 1000);
    CHECK(predicted_hits(50) < 1e-3 * inside);
  }

  TEST_CASE("meshes without area are refused, flat ones are not") {
    const ScratchFolder folder;
    const auto mesh = [&](const std::string& name, const std::function<std::string(int)>& vertex) {
      std::string text;
      for (int i = 0; i < 30; ++i) text += "v " + vertex(i) + "\n";
      for (int i = 1; i < 25; ++i)
        text += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 5) + "\n";
      return folder.file(name, text);
    };
    const auto code_and_error = [](const std::string& path) {
      return detp({"scene", path, "--rays", "100", "--field", "isotropic", "--format", "json"});
    };
    const std::string refused = "no vertex has a normal; irradiance needs triangles with an area";
    const Finished point = code_and_error(mesh("point.obj", [](int) { return std::string("1 2 3"); }));
    CHECK(point.code == 2);
    CHECK(point.err.find(refused) != std::string::npos);
    const Finished line = code_and_error(mesh("line.obj", [](int i) { return std::to_string(i) + " 0 0"; }));
    CHECK(line.code == 2);
    CHECK(line.err.find(refused) != std::string::npos);
    const Finished plane = code_and_error(
        mesh("plane.obj", [](int i) { return std::to_string(i % 5) + " " + std::to_string(i / 5) + " 0"; }));
    CHECK(plane.code == 0);
    CHECK_FALSE(has_null(plane.json().at("effects")));
  }
}

}  // namespace detp::support
