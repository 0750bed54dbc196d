#include <doctest/doctest.h>

#include "support/command.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("--light places the lights that it names, and the answer says so") {
    const Json one = detp(words("run @cornell --rays 2000 --light spot --format json")).json();
    CHECK(one.at("inputs").at("light") == Json::parse(R"([{"kind": "spot", "flux": 1.0}])"));
    CHECK(one.at("inputs").at("up") == "y");
    const Json two =
        detp(words("run @cornell --rays 2000 --light environment,directional --up z --format json")).json();
    REQUIRE(two.at("inputs").at("light").size() == 2);
    CHECK(two.at("inputs").at("light").at(0).at("kind") == "environment");
    CHECK(two.at("inputs").at("light").at(1).at("flux") == 0.5);
    CHECK(two.at("inputs").at("up") == "z");
    CHECK(one.at("hits") != two.at("hits"));
    const Finished text = detp(words("scene @cornell --rays 2000 --light area,spot"));
    CHECK(text.out.find("lights: area, spot (up: y)") != std::string::npos);
  }

  TEST_CASE("a file's emitting materials are its light; up is found for a mesh that stands along z") {
    const ScratchFolder folder;
    (void)folder.file("lamp.mtl", "newmtl lamp\nKe 5\nnewmtl floor\nKd 0.5\n");
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0.5\nv 1 0 0.5\nv 0 1 0.5\n";
    const std::string faces = "usemtl floor\nf 1 2 3\nf 1 3 4\n";
    const std::string lit = folder.file("lit.obj", "mtllib lamp.mtl\n" + square + faces + "usemtl lamp\nf 5 7 6\n");
    const Json own = detp(words("run " + lit + " --rays 1000 --format json")).json();
    CHECK(own.at("inputs").at("light").at(0).at("kind") == "surface");
    const std::string dark = folder.file("dark.obj", square + faces);
    const Json placed = detp(words("run " + dark + " --rays 1000 --disc-radius 0.1 --format json")).json();
    CHECK(placed.at("inputs").at("light").at(0).at("kind") == "area");
    CHECK(placed.at("inputs").at("up") == "z");
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("a mixed field: two techniques find the same hits, and its shares are in the answer") {
    Json hits;
    for (const std::string technique : {"box-tree", "octree"}) {
      const Json json =
          detp(words("run @cornell --field mixed:0.5:0.25:0.25 --rays 5000 --format json --technique " + technique))
              .json();
      CHECK(json.at("inputs").at("field") == "mixed");
      CHECK(json.at("inputs").at("shares").at("point") == 0.25);
      CHECK((hits.is_null() || hits == json.at("hits")));
      hits = json.at("hits");
      CHECK(hits > 1000);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("unknown lights and directions, and lights for lines or for rays from a file, are refused") {
    const auto refuses = [](const std::string& line, const std::string& message) {
      CAPTURE(line);
      const Finished finished = detp(words(line));
      CHECK(finished.code == 2);
      CHECK(finished.err.find(message) != std::string::npos);
    };
    refuses("run @cornell --light lamp", "--light must be one of");
    refuses("run @cornell --light area,", "--light must be one of");
    refuses("run @cornell --up w", "--up must be one of");
    refuses("run @cornell --light surface", "no triangle of @cornell emits light");
    refuses("run @cornell --field mixed:1:2", "three shares");
    refuses("run @cornell --field mixed::",
            "a mixture is mixed, or mixed:ISOTROPIC:DIRECTIONAL:POINT with three shares");
    refuses("run @cornell --field mixed:", "three shares");
    refuses("run @cornell --field mixed:0.5:0.2:0.2", "must add up to 1");
    refuses("run @cornell --field mixed --light spot", "these are a mixed field");
    refuses("run @uniform --light area", "--light and --up are for photon paths; these are isotropic lines");
    refuses("run @cornell --field isotropic --up z", "--light and --up are for photon paths");
    const ScratchFolder folder;
    const std::string rays = folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,0,1,0,0\n");
    refuses("run @cornell --light area --ray-file " + rays, "these are rays from a file");
  }
}

}  // namespace detp::support
