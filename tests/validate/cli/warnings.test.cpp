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
      REQUIRE(warnings.size() == 1);
      const std::string warning = warnings[0];
      CHECK(warning.find("3 of 202 discs lie far from the others") == 0);
      CHECK(finished.err.find("warning: " + warning) != std::string::npos);
      CHECK(detp(line + words("--quiet")).err.empty());
    }
  }
}

}  // namespace detp::support
