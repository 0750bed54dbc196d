#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "support/csv_answer.hpp"
#include "support/run_support.hpp"

namespace detp::support {

TEST_SUITE("run --estimator") {
  TEST_CASE("each estimator answers, names itself, and gives the room about the same mean irradiance") {
    for (const char* estimator : {"disc", "variable-radius", "nearest", "area-corrected", "triangle-hits"}) {
      CAPTURE(estimator);
      const ScratchFolder folder;
      const std::string file = folder.path("discs.csv");
      const Json answer = result_of({"run", "@cornell", "--rays", "100k", "--disc-radius", "4%", "--estimator",
                                     estimator, "--per-disc", file, "--standard-error"});
      CHECK(answer["estimator"] == estimator);
      CHECK(answer["technique"].is_null() ==
            (std::string_view(estimator) == "area-corrected" || std::string_view(estimator) == "triangle-hits"));
      CHECK(answer["mean_irradiance"].get<double>() == doctest::Approx(0.222).epsilon(0.05));
      const auto rows = rows_of(content_of(file));
      CHECK(rows.size() == 5339);
    }
  }

  TEST_CASE("the technique photon-map is the estimator nearest") {
    const Arguments line{"run", "@cornell", "--rays", "30k", "--nearest", "40"};
    const Json technique = result_of(line + Arguments{"--technique", "photon-map"});
    const Json estimator = result_of(line + Arguments{"--estimator", "nearest"});
    CHECK(technique["estimator"] == "nearest");
    CHECK(estimator["technique"] == "photon-map");
    CHECK(estimator["parameters"] == technique["parameters"]);
    CHECK(estimator["mean_irradiance"] == technique["mean_irradiance"]);
  }

  TEST_CASE("a list of estimators makes a table") {
    const Json table = result_of({"run", "@cornell", "--rays", "20k", "--estimator", "disc,triangle-hits"});
    REQUIRE(table["rows"].size() == 2);
    CHECK(table["rows"][0]["estimator"] == "disc");
    CHECK(table["rows"][1]["estimator"] == "triangle-hits");
  }

  TEST_CASE("what an estimator lacks is an error that says so") {
    const auto refuses = [](const std::string& arguments, const char* why) {
      const Finished finished = detp("run " + arguments);
      CAPTURE(arguments);
      CHECK(finished.code == 2);
      CHECK(finished.err.find(why) != std::string::npos);
    };
    refuses("@uniform --rays 1000 --estimator triangle-hits", "needs a mesh");
    refuses("@cornell --rays 1000 --field isotropic --estimator area-corrected", "which triangles");
    refuses("@cornell --rays 1000 --estimator discs", "did you mean disc");
    refuses("@cornell --rays 1000 --estimator area-corrected --technique grid", "leave out --technique");
    refuses("@cornell --rays 1000 --estimator disc --technique photon-map", "does not use photon-map");
    refuses("@cornell --rays 1000 --estimator triangle-hits --pairs /dev/null", "no pairs");
  }
}

}  // namespace detp::support
