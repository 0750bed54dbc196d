#include <doctest/doctest.h>

#include "support/csv_answer.hpp"

namespace detp::support {
namespace {

const std::string numbers = " --samples 1000 --rays 2000 --disc-radius 0.02 --scene-side 2";

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("every CSV row carries the scene, the field, the rays, the samples and the disc radius") {
    for (const std::string& line :
         {"choose" + numbers, "scene" + numbers,
          std::string("bench @uniform --rays 2000 --samples 1000 --disc-radius 0.02 --repeat 1 --techniques grid")}) {
      CAPTURE(line);
      for (const CsvRow& row : csv_of(line)) {
        CHECK(row.at("scene") == (line.starts_with("bench") ? "@uniform" : "uniform samples in a cube"));
        CHECK(row.at("field") == "isotropic");
        CHECK(row.at("rays") == "2000");
        CHECK(row.at("samples") == "1000");
        CHECK(row.at("disc_radius") == "0.02");
      }
    }
  }

  TEST_CASE("a disc radius that is given is shown digit by digit, as are counts") {
    for (const std::string& line :
         {"scene" + numbers, std::string("scene @uniform --samples 1000 --rays 2000 --disc-radius 0.02"),
          "model" + numbers, "choose" + numbers}) {
      CAPTURE(line);
      const Finished finished = detp(line + " --format json");
      CHECK(finished.out.find("\"disc_radius\": 0.02,") != std::string::npos);
      CHECK(finished.out.find("\"rays\": 2000,") != std::string::npos);
      CHECK(finished.out.find("\"samples\": 1000,") != std::string::npos);
    }
  }

  TEST_CASE("a file's name with a comma, a quote and a line feed is one field of CSV") {
    const sim::support::ScratchFolder folder;
    const std::string discs = folder.file("a,\"b\"\nc.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,1\n");
    const auto rows = csv_of(Arguments{"scene", "--discs", discs, "--disc-radius", "0.5", "--rays", "10"});
    REQUIRE(rows.size() == 1);
    CHECK(rows[0].at("scene") == discs);
  }

  TEST_CASE("choose: CSV has the candidates of JSON in their order, every count, and the paper's rule") {
    const Json json = result_of("choose" + numbers);
    const auto rows = csv_of("choose" + numbers);
    REQUIRE(rows.size() == json.at("candidates").size() + 1);
    CHECK(rows.front().at("role") == "choice");
    CHECK(rows.back().at("role") == "paper rule");
    CHECK(rows.back().at("technique") == json.at("paper_rule").at("technique"));
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      const Json& candidate = json.at("candidates")[i];
      CHECK(rows[i].at("technique") == candidate.at("technique"));
      CHECK(number(rows[i], "predicted_seconds") == candidate.at("predicted_seconds").get<double>());
      for (const auto& [term, value] : candidate.at("predicted").items())
        CHECK(number(rows[i], "predicted_" + term) == value.get<double>());
      for (const auto& [parameter, value] : candidate.at("parameters").items())
        CHECK(rows[i].at(parameter) == (value.is_string() ? value.get<std::string>() : rows[i].at(parameter)));
      CHECK(number(rows[i], "predicted_tests") ==
            number(rows[i], "predicted_sphere_tests") + number(rows[i], "predicted_disc_tests"));
    }
  }

  TEST_CASE("scene: CSV is one row with what JSON says, effects included") {
    const Json json = result_of("scene @cornell --rays 100");
    const auto rows = csv_of("scene @cornell --rays 100");
    REQUIRE(rows.size() == 1);
    CHECK(number(rows[0], "triangles") == json.at("triangles").get<double>());
    CHECK(number(rows[0], "box_x") == json.at("box")[0].get<double>());
    CHECK(number(rows[0], "sphere_radius") == json.at("sphere_radius").get<double>());
    CHECK(rows[0].at("finite_paths") == "true");
  }
}

}  // namespace detp::support
