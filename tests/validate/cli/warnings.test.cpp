#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {
namespace {

std::string mesh_with_a_stray_triangle() {
  std::string mesh;
  for (int i = 0; i < 200; ++i) mesh += "v " + std::to_string(i % 20) + " " + std::to_string(i / 20) + " 0\n";
  mesh += "v 1e6 0 0\nv 1e6 1 0\nv 1e6 0 1\n";
  for (int i = 1; i + 20 < 200; ++i)
    mesh += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 20) + "\n";
  return mesh + "f 201 202 203\n";
}

}  // namespace

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
}

}  // namespace detp::support
