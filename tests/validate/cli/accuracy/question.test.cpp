#include <doctest/doctest.h>

#include <fstream>

#include "support/run_support.hpp"

namespace detp::support {
namespace {

/// 25 discs in the middle of a wall of @furnace.
std::string discs_in_the_middle(const ScratchFolder& folder) {
  std::string path = folder.path("discs.csv");
  std::ofstream file(path);
  file << "x,y,z,nx,ny,nz,radius\n";
  for (int i = 0; i < 25; ++i) file << 0.3 + 0.1 * (i % 5) << ",0," << 0.3 + 0.1 * (i / 5) << ",0,1,0,0.05\n";
  return path;
}

/// A lamp over two floors side by side, of two materials and groups.
std::string two_floors(const ScratchFolder& folder) {
  std::ofstream(folder.path("floors.mtl")) << "newmtl left\nKd 0 0 0\nnewmtl right\nKd 0 0 0\n"
                                              "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
  std::string path = folder.path("floors.obj");
  std::ofstream file(path);
  file << "mtllib floors.mtl\n";
  for (const char* corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "2 0 0", "2 1 0", "0 0 1", "0 1 1", "1 1 1", "1 0 1"})
    file << "v " << corner << "\n";
  file << "g west\nusemtl left\nf 1 2 3 4\ng east\nusemtl right\nf 2 5 6 3\ng lamp\nusemtl lamp\nf 7 8 9 10\n";
  return path;
}

}  // namespace

TEST_SUITE("the samples in question") {
  TEST_CASE("errors are those of the discs of a file: in the middle of a wall there is no bias") {
    const ScratchFolder folder;
    const Json json = result_of("accuracy @furnace --estimators disc --discs " + discs_in_the_middle(folder));
    CHECK(json["reference"]["kind"] == "backward paths");
    CHECK(json["warnings"].dump().find("has radii") != std::string::npos);
    CHECK(json["reference"]["samples"] == 25);
    CHECK(json["answer"]["bias_interval"][0] == 0);
    CHECK(json["answer"]["bias_interval"][1].get<double>() <= 0.02);
    CHECK(json["inputs"]["disc_radius"] == 0.05);
    CHECK(std::abs(json["answer"]["mean_bias"].get<double>()) < 0.02);
    const Json all = result_of("accuracy @furnace --estimators disc --effort quick --disc-radius 0.05");
    CHECK(all["answer"]["bias_interval"][0].get<double>() > 0.02);
    CHECK(all["answer"]["mean_bias"].get<double>() < 0);
  }

  TEST_CASE("materials and groups limit what is judged; unknown ones are refused with those that there are") {
    const ScratchFolder folder;
    const std::string floors = two_floors(folder);
    const std::string command =
        "accuracy " + floors + " --estimators disc,triangle-hits --effort quick --target-noise 20%";
    const Json left = result_of(command + " --material left");
    const Json west = result_of(command + " --group west");
    CHECK(left["reference"]["samples"] == 4);
    CHECK(left["answer"]["bias"] == west["answer"]["bias"]);
    CHECK(result_of(command + " --material left,right")["reference"]["samples"] == 6);
    const Json run = result_of("run " + floors + " --target-noise 20% --group west --disc-radius 0.1");
    CHECK(run["stopped_because"] == "target");
    CHECK(run["inputs"]["groups"] == Json::array({"west"}));
    check_refused({{command + " --material front", "left"},
                   {command + " --group north", "west"},
                   {"accuracy @furnace --group west", "group"},
                   {"run " + floors + " --group west", "--target-noise"}});
  }

  TEST_CASE("rays of a file have no scene to judge by: half the radius with the same rays does") {
    const ScratchFolder folder;
    const std::string rays = folder.path("rays.csv");
    const std::string discs = folder.path("discs.csv");
    REQUIRE(detp("scene @furnace --rays 100000 --write-rays " + rays + " --write-discs " + discs).code == 0);
    const Finished run =
        detp("run --discs " + discs + " --ray-file " + rays + " --target-error 50% --disc-radius 0.05 --format json");
    const Json json = Json::parse(run.out);
    CHECK(json["bias_by"].get<std::string>().find("half the radius") != std::string::npos);
    CHECK(json["bias_interval"][1].get<double>() > 0);
    CHECK(json["error"].get<double>() >= json["noise"].get<double>());
  }
}

}  // namespace detp::support
