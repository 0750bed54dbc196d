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
#include "support/run_support.hpp"

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

std::string mesh_with_a_stray_triangle() {
  std::string mesh;
  for (int i = 0; i < 200; ++i) mesh += "v " + std::to_string(i % 20) + " " + std::to_string(i / 20) + " 0\n";
  mesh += "v 1e6 0 0\nv 1e6 1 0\nv 1e6 0 1\n";
  for (int i = 1; i + 20 < 200; ++i)
    mesh += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 20) + "\n";
  return mesh + "f 201 202 203\n";
}

std::vector<std::filesystem::path> meshes_in(const std::string& folder) {
  std::vector<std::filesystem::path> meshes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".obj" || entry.path().extension() == ".ply") meshes.push_back(entry.path());
  std::sort(meshes.begin(), meshes.end());
  return meshes;
}

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("scene and choose answer in finite numbers for degenerate rays and discs" * doctest::test_suite("long")) {
    const ScratchFolder folder;
    const auto rays = ray_files(folder);
    for (const File& discs : disc_files(folder))
      for (const File& some : rays) {
        INFO("discs.name ", discs.name, ", some.name ", some.name);
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

TEST_SUITE("end to end") {
  TEST_CASE("choose, run and scene warn of a stray triangle: on stderr unless quiet, and in JSON") {
    const support::ScratchFolder folder;
    const std::string mesh = folder.file("stray.obj", mesh_with_a_stray_triangle());
    for (const std::string command : {"choose", "run", "scene"}) {
      CAPTURE(command);
      const Arguments line{command, mesh, "--rays", "100", "--format", "json"};
      const Finished finished = detp(line);
      CHECK(finished.code == 0);
      const Json warnings = finished.json().at("warnings");
      REQUIRE_FALSE(warnings.empty());
      for (const std::string one : warnings) CHECK(finished.err.find(one) != std::string::npos);
      CHECK(warnings.dump().find("\"3 of 219 discs lie far from the others") != std::string::npos);
      CHECK(finished.err.find("warning: 3 of 219 discs lie far from the others") != std::string::npos);
      CHECK(detp(line + words("--quiet")).err.empty());
    }
  }

  TEST_CASE("scene remarks on samples along lines, and the samples that it suggests lie on surfaces") {
    const support::ScratchFolder folder;
    // A room: two large walls of few vertices, and a picture rail of many.
    std::string mesh = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 0\nf 1 2 3\nf 2 4 3\n";
    for (int i = 0; i <= 1000; ++i) {
      const std::string x = std::to_string(0.01 * i);
      mesh += "v " + x + " 5 0.1\nv " + x + " 5.01 0.1\n";
      const int first = 5 + 2 * i;
      if (i > 0)
        mesh += "f " + std::to_string(first - 2) + " " + std::to_string(first) + " " + std::to_string(first + 1) + "\n";
    }
    const std::string room = folder.file("room.obj", mesh);
    const Arguments line{"scene", room, "--rays", "100", "--quiet"};
    const Json json = result_of(line);
    CHECK(json.at("dimension").get<double>() < 1.5);
    REQUIRE(json.at("remarks").size() == 1);
    const std::string remark = json.at("remarks")[0];
    CHECK(detp(line).out.find("remark    D = 1.") != std::string::npos);
    std::smatch suggested;
    REQUIRE(std::regex_search(remark, suggested, std::regex("--samples ([0-9]+) ")));
    const Json better = result_of(line + Arguments{"--samples", suggested[1]});
    CHECK(better.at("dimension").get<double>() > 1.5);
    CHECK(better.at("remarks").empty());
    CHECK(result_of("scene @cornell --rays 100").at("remarks").empty());
  }

  TEST_CASE("every test mesh is opened and described, or refused with a reason" * doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    for (const std::filesystem::path& mesh : meshes_in(folder)) {
      CAPTURE(mesh.string());
      const Arguments arguments{"scene", mesh.string(), "--rays", "1000"};
      const std::string name = mesh.filename().string();
      if (name == "no_faces.obj" || name == "nonfinite_vertices.obj") {
        check_refused({{arguments, name + ": "}});
        continue;
      }
      const Json json = result_of(arguments);
      CHECK(json.at("triangles").get<std::uint64_t>() > 0);
      CHECK(json.at("samples").get<std::uint64_t>() > 0);
      CHECK(json.at("rays") >= 1000);  // whole photons
      const std::string warnings = json.at("warnings").dump();
      const bool distorted = warnings.find("lie far from the others") != std::string::npos ||
                             warnings.find("times the median") != std::string::npos;
      CAPTURE(warnings);
      CHECK(distorted == (name == "mixed_scale.obj"));
      CHECK(json.at("sphere_radius").get<double>() > 0);
    }
  }

  TEST_CASE("techniques agree with brute force on meshes" * doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    for (const std::string name :
         {"/cornell_box.obj", "/stanford_dragon.ply", "/tangerine_coarse.ply", "/pathological/degenerate_mix.obj"})
      check_all_agree(Arguments{"run", folder + name} + words("--rays 400 --disc-radius 1.5% --quiet"));
  }

  TEST_CASE("techniques agree with brute force at scales of 1e12 and 1e-12 and far from the origin" *
            doctest::test_suite("scenes")) {
    const std::string folder = support::scenes_folder();
    if (folder.empty()) return;
    for (const std::string name : {"huge_scale.obj", "tiny_scale.obj", "huge_offset.obj", "flat_axis_aligned.obj"})
      check_all_agree(Arguments{"run", folder + "/pathological/" + name} +
                      words("--rays 400 --disc-radius 2.3% --quiet"));
  }
}

}  // namespace detp::support
