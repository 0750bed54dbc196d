#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support/command.hpp"

namespace detp::support {
namespace {

/// A closed unit cube of shared corners, each wall in two triangles; all walls have the material "w".
std::string cube(bool inwards) {
  const char* const faces[] = {"1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};  // outwards
  std::string text = "mtllib cube.mtl\nusemtl w\n";
  for (const char* corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"})
    text += std::string("v ") + corner + "\n";
  for (const char* face : faces) {
    std::string corners = face;
    if (inwards) std::reverse(corners.begin(), corners.end());
    text += "f " + corners + "\n";
  }
  return text;
}

double sum_of_shares(const Json& light) {
  return light.at("absorbed_share").get<double>() + light.at("left_share").get<double>() +
         light.at("cut_share").get<double>();
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("results say where the light went and what became of the faces" * doctest::test_suite("long")) {
    for (const char* command : {"run @tree --rays 3000", "scene @tree --rays 3000", "choose @tree --rays 3000",
                                "run @tree --rays 400k --technique box-tree"}) {
      CAPTURE(command);
      const Json json = result_of(command);
      const Json& light = json.at("light");
      CHECK(light.at("photons") == json.value("photons", light.at("photons")));
      CHECK(light.at("absorbed").get<int>() + light.at("left").get<int>() + light.at("cut").get<int>() ==
            light.at("photons"));
      CHECK(std::abs(sum_of_shares(light) - 1) < 1e-12);
      CHECK(light.at("left").get<int>() > 0);
      CHECK(light.at("cut") == 0);
      CHECK(light.at("landings").get<double>() > 0.3);
      for (const char* count : {"polygons_split", "not_plane", "degenerate", "coincident", "normals_made"})
        CHECK(json.at("geometry").at(count) == 0);
    }
    const Json until = result_of("run @cornell --target-noise 5% --estimator triangle-hits");
    CHECK(until.at("rays").get<double>() > (1 << 16) + 1000);  // more than the first stage
    CHECK(until.at("light").at("photons") == until.at("photons"));
    CHECK(std::abs(sum_of_shares(until.at("light")) - 1) < 1e-12);
    const Json accuracy = result_of("accuracy @cornell --effort quick --estimators triangle-hits");
    CHECK(accuracy.at("light").at("photons").get<double>() > 1000);
    CHECK(std::abs(sum_of_shares(accuracy.at("light")) - 1) < 1e-12);
    CHECK(accuracy.at("geometry").at("degenerate") == 0);
    CHECK(accuracy.at("warnings").empty());
    const Json lines = result_of("run @tree --field isotropic --rays 3000");
    CHECK_FALSE(lines.contains("light"));
    CHECK(lines.at("geometry").at("samples_unlit").get<int>() > 0);
    CHECK(detp("run @tree --rays 3000").out.find("% left the scene") != std::string::npos);
  }

  TEST_CASE("walls that emit outwards are named, and nothing is a bare 0" * doctest::test_suite("long")) {
    const ScratchFolder folder;
    (void)folder.file("cube.mtl", "newmtl w\nKd 0.5\nKe 1\n");
    const std::string outwards = folder.file("outwards.obj", cube(false));
    const std::string inwards = folder.file("inwards.obj", cube(true));
    for (const std::string& command : {"run " + outwards + " --rays 20000 --estimator triangle-hits",
                                       "scene " + outwards + " --rays 20000", "choose " + outwards + " --rays 20000"}) {
      CAPTURE(command);
      const Finished finished = detp(command + " --format json");
      CHECK(finished.code == 0);
      CHECK(finished.err.find("100 % of the light leaves the scene without meeting a surface") != std::string::npos);
      const Json json = finished.json();
      CHECK(json.at("light").at("left_share") == 1);
      CHECK(json.at("warnings").dump().find("do emitters face outwards?") != std::string::npos);
      if (command.starts_with("run"))
        CHECK(json.at("warnings").dump().find("no photon meets a surface") != std::string::npos);
    }
    for (const std::string& command : {"accuracy " + outwards, "run " + outwards + " --target-error 5%"}) {
      CAPTURE(command);
      const Finished finished = detp(command);
      CHECK(finished.code == 2);
      CHECK(finished.err.find("100 % of the light leaves the scene without meeting a surface") != std::string::npos);
    }
    const Finished in = detp("run " + inwards + " --rays 20000 --estimator triangle-hits --format json");
    CHECK(in.err.empty());
    // 10 000 photons whose numbers of landings have a relative deviation of 0.71: 4.5 of it
    CHECK(std::abs(in.json().at("mean_irradiance").get<double>() / (2 * 3.14159265) - 1) < 0.032);
    CHECK(in.json().at("light").at("absorbed_share") == 1);
    const Finished unmet =
        detp("run " + inwards + " --rays 20000 --technique box-tree --crease 180 --effects none --format json");
    REQUIRE(unmet.json().at("hits") == 0);
    CHECK(unmet.json().at("warnings").dump().find("although photons land") != std::string::npos);
  }

  TEST_CASE("a run whose discs lie apart from the rays says so") {
    const ScratchFolder folder;
    const std::string discs = folder.file("discs.csv", "x,y,z,nx,ny,nz,radius\n9,0,0,0,0,1,0.1\n");
    const std::string rays = folder.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,1,0,0,-1\n0,1,1,0,0,-1\n");
    const Finished finished = detp("run --discs " + discs + " --ray-file " + rays + " --format json");
    CHECK(finished.code == 0);
    CHECK(finished.err.find("no hits: none of 2 rays meets one of 1 discs: do the discs lie where the rays are") !=
          std::string::npos);
    CHECK(finished.json().value("geometry", Json()).is_null());
  }

  TEST_CASE("lines of a workload in numbers cross S0 of the given cube, however few samples it has" *
            doctest::test_suite("long")) {
    // A line through S0 hits a disc with the probability d^2 / (2 r0^2).
    for (const int samples : {1, 2, 10, 1000}) {
      CAPTURE(samples);
      const Json json =
          result_of("run --rays 1e6 --scene-side 2 --disc-radius 0.02 --samples " + std::to_string(samples));
      const double r0 = std::sqrt(3.0) + 0.02;
      const double expected = 1e6 * samples * 0.02 * 0.02 / (2 * r0 * r0);
      CHECK(std::abs(json.at("hits").get<double>() - expected) < 4.5 * std::sqrt(expected));
      CHECK(json.at("inputs").at("scene_side") == 2);
      CHECK(json.at("inputs").at("sphere_radius").get<double>() == doctest::Approx(r0));
    }
  }

  TEST_CASE("walls that absorb nothing are named, and their light is cut") {
    const ScratchFolder folder;
    (void)folder.file("cube.mtl", "newmtl w\nKd 1\nKe 1\n");
    const Finished finished =
        detp("run " + folder.file("cube.obj", cube(true)) + " --rays 1000 --estimator triangle-hits --format json");
    CHECK(finished.code == 0);
    CHECK(finished.err.find("materials that absorb nothing (w): 1") != std::string::npos);
    CHECK(finished.err.find("of the light, were cut after") != std::string::npos);
    CHECK(finished.json().at("light").at("cut_share") == 1);
  }
}

}  // namespace detp::support
