#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "support/attempts.hpp"
#include "support/csv_answer.hpp"
#include "support/machine.hpp"
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

TEST_SUITE("accuracy") {
  TEST_CASE("an answer has setting, errors, seconds and a command; running the command gives about the noise" *
            doctest::test_suite("long")) {
    const Json json = result_of("accuracy @cornell --target-noise 10% --estimators disc,triangle-hits --check");
    const Json& answer = json["answer"];
    CHECK(answer["noise"].get<double>() == doctest::Approx(0.1).epsilon(1e-3));
    CHECK(answer["measured_noise"].get<double>() == doctest::Approx(0.1).epsilon(0.2));
    CHECK(answer["checked"]["rays"].get<double>() ==
          doctest::Approx(answer["measured_rays"].get<double>()).epsilon(0.01));
    CHECK(json["ties"].is_array());
    CHECK_FALSE(answer["noise_weak"].get<bool>());
    CHECK(answer["error"].get<double>() >= answer["noise"].get<double>());
    CHECK(answer["error_interval"][0].get<double>() <= answer["error"].get<double>());
    CHECK(answer["measured_seconds"].get<double>() > 0);
    CHECK(json["points"].size() > 6);
    for (const Json& point : json["points"]) {
      CHECK(point["processor_seconds"].get<double>() >= point["predicted_seconds"].get<double>());
      CHECK(point["cut_off"] == (point["estimator"] != "gather" && point["rays"].get<double>() >= 1e9));
    }
    CHECK(json["stopped"] == false);
    const std::string command = answer["command"];
    REQUIRE(command.starts_with("detp run @cornell --rays "));
    const Json run = result_of(command.substr(5));
    CHECK(run["estimator"] == answer["estimator"]);
    CHECK(run["rays"].get<double>() == doctest::Approx(answer["rays"].get<double>()).epsilon(0.01));
  }

  TEST_CASE("the same seed gives the same answer, not run to check; whatever else the machine does" *
            doctest::test_suite("long")) {
    const std::string command = "accuracy @cornell --target-noise 10% --effort quick";
    const Json json = result_of(command);
    const Json one = result_of(command + " --threads 2");
    const Json again = result_of(command + " --threads 2");
    CHECK(one["answer"] == again["answer"]);
    CHECK(one["points"] == again["points"]);
    CHECK(json["inputs"]["effort"] == "quick");
    CHECK_FALSE(json["answer"].contains("measured_noise"));
    CHECK(json["answer"]["noise"].get<double>() == doctest::Approx(0.1).epsilon(1e-3));
  }

  TEST_CASE("an error below every estimator's bias ends with 3, and says what gets nearest" *
            doctest::test_suite("long")) {
    const Finished finished = detp("accuracy @cornell --target-error 1% --estimators disc --rays 1M");
    CHECK(finished.code == 3);
    CHECK(finished.out.find("is not reached: the least bias") != std::string::npos);
    CHECK(finished.out.find("partial") == std::string::npos);
  }

  TEST_CASE("the answer is run with more seeds, and compared with a reference that is kept in a file" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string file = folder.path("furnace.json");
    const std::string command =
        "accuracy @furnace --target-noise 20% --estimators disc --check --seeds 3:7 --reference " + file;
    const Json json = result_of(command);
    CHECK(json["reference"]["kind"] == "known");
    CHECK(json["reference"]["error"] == 0);
    CHECK(json["answer"]["within"] == 0.2);
    CHECK(json["answer"]["share_within"].get<double>() > 0.5);
    CHECK(json["answer"]["share_within"].get<double>() < 1);
    CHECK(json["answer"]["slope"].get<double>() < 0);
    const Json& runs = json["reruns"]["runs"];
    REQUIRE(runs.size() == 5);
    CHECK(runs[0]["seed"] == 3);
    CHECK(runs[4]["seed"] == 7);
    for (const Json& run : runs) {
      CHECK(run["noise"].get<double>() == doctest::Approx(0.2).epsilon(0.3));
      CHECK(run["error"].get<double>() >= 0.5 * run["noise"].get<double>());
    }
    CHECK(std::filesystem::exists(file));
    const std::string csv = detp(command + " --axis arithmetic --format csv").out;
    for (const CsvRow& row : csv_rows(csv)) {
      CHECK(row.at("target_kind") == "noise");
      CHECK_FALSE(row.at("target").empty());
      CHECK(row.at("planning_seconds").empty() == (row.at("role") != "answer"));
    }
    CHECK(csv.find(",run,") != std::string::npos);
    CHECK(csv.find(",arithmetic,") != std::string::npos);
    check_refused({{"accuracy @cornell --target-noise 20% --reference " + file, "another scene"}});
  }

  TEST_CASE("other axes add points with an error, a time and what the error is of" * doctest::test_suite("long")) {
    const Json json =
        result_of("accuracy @furnace --target-noise 20% --estimators disc --axis simulation,model,arithmetic");
    std::map<std::string, int> count;
    for (const Json& point : json["points"]) {
      ++count[point["axis"]];
      if (point["axis"] == "estimator") continue;
      CHECK(point["measured_seconds"].get<double>() > 0);
      const Json& interval = point["error_interval"];
      if (interval.is_null()) continue;
      CHECK(interval[0].get<double>() <= point["error"].get<double>());
      CHECK(interval[1].get<double>() >= point["error"].get<double>());
      CHECK_FALSE(point["quantity"].get<std::string>().empty());
    }
    CHECK(count["estimator"] > 0);
    CHECK(count["simulation"] == 10);
    CHECK(count["model"] >= 5);
    CHECK(count["arithmetic"] == 8);
  }

  TEST_CASE("bad requests are refused with the reason") {
    check_refused({{"accuracy @uniform", "has no triangles"},
                   {"accuracy @cornell --target-noise 5% --target-error 5%", "give one of"},
                   {"accuracy @cornell --target-noise 0", "target error"},
                   {"accuracy @cornell --target-error 200%", "target error"},
                   {"accuracy @cornell --time-budget -1", "time budget"},
                   {"accuracy @cornell --estimators discs", "there is no estimator"},
                   {"accuracy @cornell --rays 10", "--rays"},
                   {"accuracy @cornell --axis arithmetik", "--axis must be one of"},
                   {"accuracy @cornell --seeds 5:5", "number of seeds"},
                   {"accuracy @cornell --seeds 5", "--seeds takes the first and the last seed"},
                   {"accuracy @cornell --seeds 5:4", "--seeds takes the first and the last seed"},
                   {"accuracy @cornell --seeds 1:x", "--seeds must be a whole number"},
                   {"accuracy @cornell --reference /nowhere/reference.json", "/nowhere/reference.json"},
                   {"accuracy missing.obj", "missing.obj"}});
  }
}

TEST_SUITE("long") {
  TEST_CASE("the text has at most 25 lines, and the CSV a row for each point") {
    const Finished text = detp("accuracy @cornell --target-noise 10% --quiet");
    CHECK(text.code == 0);
    CHECK(std::ranges::count(text.out, '\n') <= 25);
    CHECK(text.out.starts_with("answer    10 % noise takes "));
    const Finished csv = detp("accuracy @cornell --target-noise 10% --estimators disc --format csv");
    CHECK(csv.code == 0);
    CHECK(std::ranges::count(csv.out, '\n') > 4);
  }

  TEST_CASE("a time budget is kept, and gives the most accurate setting") {
    const double budget = sanitized ? 6 : 0.3;
    CHECK(in_attempts(3, [&] {  // what takes long in a pilot may take longer than the budget
      const Json json = result_of(fmt::format("accuracy @furnace --time-budget {}", budget));
      CHECK(json["inputs"]["time_budget"] == budget);
      return std::abs(json["answer"]["predicted_seconds"].get<double>() / budget - 1) < 0.01;
    }));
  }
}

TEST_SUITE("the samples in question") {
  TEST_CASE("errors are those of the discs of a file: in the middle of a wall there is no bias" *
            doctest::test_suite("long")) {
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
    const std::string fronts = "accuracy @furnace --estimators disc --effort quick --disc-radius 0.05 --front-facing";
    CHECK(result_of(fronts)["answer"]["command"].get<std::string>().find(" --front-facing") != std::string::npos);
    CHECK(all["answer"]["bias_interval"][0].get<double>() > 0.02);
    CHECK(all["answer"]["mean_bias"].get<double>() < 0);
  }

  TEST_CASE("materials and groups limit what is judged; unknown ones are refused with those that there are" *
            doctest::test_suite("long")) {
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
