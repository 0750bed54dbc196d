#include <doctest/doctest.h>

#include <numbers>

#include "support/csv_answer.hpp"
#include "support/run_support.hpp"

namespace detp::support {

TEST_SUITE("run --estimator") {
  TEST_CASE("each estimator answers, names itself, and gives the room about the same mean irradiance" *
            doctest::test_suite("long")) {
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

  TEST_CASE("gather: 1 on the sunlit floor, and the room's irradiance as others find it, without rays and photons" *
            doctest::test_suite("long")) {
    const Json floor = result_of("run @sunlit --estimator gather --samples 300 --paths 100");
    CHECK(floor["mean_irradiance"].get<double>() == doctest::Approx(1).epsilon(1e-6));
    CHECK(floor["inputs"]["paths"] == 100);
    const ScratchFolder folder;
    const std::string file = folder.path("discs.csv");
    const Finished finished = detp("run @cornell --estimator gather --format json --standard-error --per-disc " + file);
    const Json room = finished.json();
    CHECK(room["estimator"] == "gather");
    CHECK(room["technique"].is_null());
    CHECK(room["paths"] == 64);
    CHECK(room["inputs"]["paths"] == 64);
    CHECK(room["rays"] == 0);
    CHECK(room["photons"] == 0);
    CHECK(room["inputs"]["rays"] == 0);
    CHECK_FALSE(room["inputs"].contains("field"));
    CHECK(room["effects"].empty());
    CHECK(room["seconds"]["search"].get<double>() > 0);
    CHECK(room["hits"].get<double>() > 0);
    CHECK(room["mean_irradiance"].get<double>() == doctest::Approx(0.222).epsilon(0.05));
    CHECK(room["missed_share_bound"] == 0);
    CHECK(room["warnings"].empty());
    CHECK(finished.err.empty());
    CHECK_FALSE(has_no_number(finished.out));
    const std::vector<CsvRow> rows = csv_rows(content_of(file));
    REQUIRE(rows.size() == 5339);
    std::size_t stated = 0;
    for (const CsvRow& row : rows) stated += row.at("standard_error").empty() ? 0 : 1;
    CHECK(stated > rows.size() * 9 / 10);  // not where no light is
    const Finished again =
        detp("run @cornell --estimator gather --format json --threads 1 --repeat 2 --per-disc " + file);
    CHECK(again.json()["mean_irradiance"] == room["mean_irradiance"]);
    CHECK(again.json()["seconds"]["all"].size() == 2);
    const Finished text = detp("run @cornell --estimator gather --samples 100 --paths 7 --verbose");
    CHECK(text.out.find("gather, 7 backward paths per disc and side") != std::string::npos);
    CHECK(text.out.find("rays ") == std::string::npos);
  }

  TEST_CASE("gather with discs of a file beside a scene, and in a table with others, which alone have rays" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string discs = folder.file("two.csv", "x,y,z,nx,ny,nz,radius\n.5,0,.5,0,1,0,.1\n.4,0,.6,0,1,0,.1\n");
    const Json two = result_of("run @furnace --estimator gather --paths 4000 --discs " + discs);
    CHECK(two["hits_per_disc"] == 4000);  // each meets a wall that emits
    CHECK(two["mean_irradiance"].get<double>() == doctest::Approx(2 * std::numbers::pi).epsilon(0.02));
    const Json table =
        result_of("run @cornell --rays 2k,5k --samples 200 --estimator gather,area-corrected --seeds 1:2");
    REQUIRE(table["rows"].size() == 8);
    for (std::size_t i = 0; i < 8; ++i) {
      const Json& row = table["rows"][i];
      const bool gathers = row["estimator"] == "gather";
      CHECK((row["rays"] == 0) == gathers);
      CHECK((row["photons"] == 0) == gathers);
      CHECK(row.contains("paths") == gathers);
      CHECK(row["inputs"].contains("paths") == gathers);
    }
    CHECK(table["rows"][0]["mean_irradiance"] == table["rows"][4]["mean_irradiance"]);  // other rays
    CHECK(table["rows"][0]["mean_irradiance"] != table["rows"][2]["mean_irradiance"]);  // another seed
    const Json paths = result_of("run @cornell --samples 50 --estimator gather --paths 1,10,1k");
    REQUIRE(paths["rows"].size() == 3);
    CHECK(paths["rows"][2]["paths"] == 1000);
    CHECK(detp("run @cornell --samples 50 --estimator gather --format csv").out.find(",gather,64,") !=
          std::string::npos);
  }

  TEST_CASE("gather says how much light it misses") {
    const Finished finished = detp("run @caustic --estimator gather --samples 100 --paths 2 --format json");
    const Json json = finished.json();
    CHECK(json["missed_share"].get<double>() > 0.01);
    CHECK(json["missed_share_bound"].get<double>() > json["missed_share"].get<double>());
    CHECK(json["missed_share_bound"].get<double>() < 1);
    REQUIRE(json["warnings"].size() == 1);
    CHECK(json["warnings"][0].get<std::string>().find("% of the light on surfaces is missing") != std::string::npos);
    CHECK(finished.err.find("is missing") != std::string::npos);
    CHECK(result_of("run @caustic --light area --estimator gather --samples 100 --paths 2")["warnings"].empty());
  }

  TEST_CASE("a run by paths stops in time, and says at how many discs it was") {
    const Finished finished =
        stopped_in_time("run @cornell --estimator gather --paths 1M --format json",
                        [](const Finished& one) { return one.code == 3 && one.json().contains("mean_irradiance"); });
    CHECK(finished.code == 3);
    const Json json = finished.json();
    CHECK(json["stopped"] == true);
    CHECK(json["mean_irradiance"].is_null());
    CHECK(json["stopped_after"]["of"] == 5339);
    CHECK(json["stop_seconds"].get<double>() < 0.2);
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
    for (const char* option : {"--rays 1000", "--ray-file none.csv", "--field photons", "--second-intersection"})
      refuses("@cornell --estimator gather " + std::string(option), "traces no photons: leave out --");
    refuses("@cornell --estimator gather --target-noise 5%", "traces no photons");
    refuses("@cornell --estimator gather --technique grid", "leave out --technique");
    refuses("@cornell --estimator gather --pairs /dev/null", "no pairs");
    refuses("@cornell --estimator gather --paths 0", "--paths");
    refuses("@cornell --estimator gather --paths 1.5", "--paths");
    refuses("@cornell --paths 10", "--paths is for --estimator gather");
    refuses("@uniform --estimator gather", "needs a scene with triangles");
    refuses("--estimator gather --samples 10 --disc-radius 0.1 --scene-side 1", "needs a scene");
    refuses("@cornell --rays 1000 --estimator gather,disc --light surface --field isotropic", "photon paths");
  }

  TEST_CASE("a parameter is used, or refused: never ignored") {
    CHECK(result_of("run @cornell --rays 2000 --leaf 8")["parameters"]["leaf"] == 8);
    CHECK(result_of("run @cornell --rays 2000 --ratio 0.65")["technique"] == "sphere-cache");
    CHECK(result_of("run @cornell --target-noise 50% --leaf 8")["parameters"]["leaf"] == 8);
    CHECK(result_of("run @cornell --rays 2000 --estimator disc,nearest --nearest 20")["rows"].size() == 2);
    for (const std::string wrong : {"--nearest 3", "--estimator triangle-hits --leaf 8", "--leaf 8 --cells 3"}) {
      CAPTURE(wrong);
      CHECK(detp("run @cornell --rays 2000 " + wrong).code == 2);
    }
  }
}

}  // namespace detp::support
