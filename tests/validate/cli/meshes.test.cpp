#include <doctest/doctest.h>

#include "support/run_support.hpp"

namespace detp::support {
namespace {

std::vector<std::filesystem::path> meshes_in(const std::string& folder) {
  std::vector<std::filesystem::path> meshes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".obj" || entry.path().extension() == ".ply") meshes.push_back(entry.path());
  std::sort(meshes.begin(), meshes.end());
  return meshes;
}

}  // namespace

TEST_SUITE("end to end") {
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
