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

  TEST_CASE("a disc radius from the command line is shown digit by digit, as are counts") {
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

  TEST_CASE("one per cent of @uniform, a cube of side 2, is 0.02 for any number of samples") {
    for (const std::string samples : {"100", "1000"})
      CHECK(csv_of("scene @uniform --rays 10 --disc-radius 1% --samples " + samples)[0].at("disc_radius") == "0.02");
    const auto rows = csv_of("run @uniform --rays 10 --samples 20 --disc-radius 1%,2%,4% --technique grid --seed 9");
    REQUIRE(rows.size() == 3);
    CHECK(rows[0].at("disc_radius") == "0.02");
    CHECK(rows[1].at("disc_radius") == "0.04");
    CHECK(rows[2].at("disc_radius") == "0.08");
    CHECK(rows[2].at("seed") == "9");
  }

  TEST_CASE("a file's name with a comma, a quote and a line feed is one field of CSV") {
    const support::ScratchFolder folder;
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
            number(rows[i], "predicted_cull_tests") + number(rows[i], "predicted_disc_tests"));
    }
  }

  TEST_CASE("choose and scene: CSV has the effects, warnings and reasons of JSON in every row" *
            doctest::test_suite("long")) {
    const support::ScratchFolder folder;
    std::string discs = "x,y,z,nx,ny,nz\n";
    for (int i = 0; i < 100; ++i) discs += std::to_string(0.01 * i) + ",0,0,0,0,1\n";
    const std::string path = folder.file("discs.csv", discs + "1000,0,0,0,0,1\n");
    const Arguments stray = Arguments{"--discs", path} + words("--disc-radius 0.1 --rays 100 --quiet");
    for (const Arguments& workload : {stray, words("@cornell --rays 100")})
      for (const std::string command : {"choose", "scene"}) {
        const Json json = result_of(Arguments{command} + workload);
        std::string warnings;
        for (const std::string one : json.at("warnings")) warnings += (warnings.empty() ? "" : "; ") + one;
        CHECK(warnings.empty() == (workload != stray));
        for (const CsvRow& row : csv_of(Arguments{command} + workload)) {
          CHECK(row.at("warnings") == warnings);
          for (const Json& effect : json.at("effects")) {
            std::string column = effect.at("name");
            std::replace(column.begin(), column.end(), ' ', '_');
            CHECK(row.at(column) == effect.at("on").dump());
            CHECK(number(row, column + "_value") == effect.at("value").get<double>());
          }
          if (command == "scene") continue;
          const std::string text = detp(Arguments{command, "--verbose"} + workload).out;
          for (const Json& effect : json.at("effects"))
            if (effect.at("on") == true) {
              const std::string first = effect.at("name").get<std::string>() + " (";
              CHECK(text.find("effects   on: " + first) != std::string::npos);
              break;
            }
          CHECK(row.at("extrapolated_because").empty() == (row.at("extrapolated") == "false"));
        }
      }
  }

  TEST_CASE("choose --analyze: CSV has JSON's lists of candidates that were tried and abandoned, and of errors" *
            doctest::test_suite("long")) {
    const auto rows = csv_of(
        "choose @uniform --samples 5000 --rays 5000 --disc-radius 1% --analyze "
        // With these costs, brute force has by far the shortest predicted time.
        "--costs t=1,u=1e-18,w=1,v=1,n=1,c=1,b=1,s=1,r=1");
    int tried = 0;
    int missed = 0;
    for (const CsvRow& row : rows) {
      tried += row.at("measured_seconds").empty() && row.at("given_up_after_seconds").empty() ? 0 : 1;
      if (row.at("seconds_ratio").empty()) continue;
      ++missed;
      CHECK(number(row, "seconds_ratio") ==
            doctest::Approx(number(row, "predicted_seconds") / number(row, "measured_seconds")));
      CHECK_FALSE(row.at("worst_count").empty());
    }
    CHECK(missed >= 2);
    CHECK(rows.front().at("role") == "predicted choice");
    CHECK(rows.front().at("technique") == "brute-force");
    CHECK(std::stoi(rows.front().at("tried")) == tried);
  }

  TEST_CASE("validate: each claim has its technique in JSON and CSV, and none if it is about lines" *
            doctest::test_suite("long")) {
    const std::string line = "validate @cornell --samples 100 --rays 320 --disc-radius 4% --format ";
    const Json json = detp(line + "json").json();
    const auto rows = csv_rows(detp(line + "csv").out);
    REQUIRE(rows.size() == json.at("claims").size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Json& claim = json.at("claims")[i];
      const std::string id = claim.at("id");
      CAPTURE(id);
      CHECK(rows[i].at("id") == id);
      for (const char* key : {"technique", "parameters"})
        CHECK(rows[i].at(key) == (claim.at(key).is_null() ? "" : claim.at(key).get<std::string>()));
      if (id.starts_with("choice.")) CHECK(id.starts_with("choice." + rows[i].at("technique") + "."));
      if (id.starts_with("octree")) CHECK(rows[i].at("technique") == "octree");
      if (id.starts_with("rebuild")) CHECK(rows[i].at("technique") == "sphere-cache");
      if (id.starts_with("disc-hit") || id.starts_with("hits")) CHECK(rows[i].at("technique").empty());
    }
  }

  TEST_CASE("a range has the values that a reader would write, including its end if a step meets it") {
    const auto ratios = [](const std::string& range) {
      std::vector<std::string> values;
      for (const CsvRow& row : csv_of("model" + numbers + " --levels 0 --ratio " + range))
        values.push_back(row.at("ratio"));
      return values;
    };
    CHECK(ratios("0.3:0.9:0.05") == std::vector<std::string>{"0.3", "0.35", "0.4", "0.45", "0.5", "0.55", "0.6", "0.65",
                                                             "0.7", "0.75", "0.8", "0.85", "0.9"});
    CHECK(ratios("0.3:0.9:0.25") == std::vector<std::string>{"0.3", "0.55", "0.8"});
    CHECK(ratios("0.3:0.3:0.1") == std::vector<std::string>{"0.3"});
    CHECK(ratios("0.9:0.3:-0.3") == std::vector<std::string>{"0.9", "0.6", "0.3"});
    CHECK(ratios("5e-1,6e-1:8e-1:1e-1,0.85") == std::vector<std::string>{"0.5", "0.6", "0.7", "0.8", "0.85"});
    const auto rows = csv_of("model --samples 1000 --disc-radius 0.02 --scene-side 2 --rays 1e3:3e3:1e3");
    REQUIRE(rows.size() == 3);
    CHECK(rows[2].at("rays") == "3000");
    CHECK(csv_of("model --samples 1000 --disc-radius 1%:3%:1% --scene-side 2")[2].at("disc_radius") == "0.06");
  }

  TEST_CASE("each combination is a row: the scene's options change slowest, the last parameter and form fastest") {
    const auto rows = csv_of(
        "model --samples 1000 --rays 2000 --scene-side 2 --disc-radius 0.02,0.04 --ratio 0.5,0.6 "
        "--form published,corrected");
    REQUIRE(rows.size() == 8);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      CHECK(rows[i].at("disc_radius") == (i < 4 ? "0.02" : "0.04"));
      CHECK(rows[i].at("ratio") == (i % 4 < 2 ? "0.5" : "0.6"));
      CHECK(rows[i].at("form") == (i % 2 == 0 ? "published" : "corrected"));
    }
  }

  TEST_CASE("a row of a table equals the result of its own command, in JSON and CSV") {
    const std::string model = "model --samples 1000 --rays 2000 --scene-side 2 ";
    const Json table = result_of(model + "--disc-radius 0.02,0.04 --ratio 0.5,0.6 --levels 3");
    CHECK_FALSE(table.contains("k"));
    CHECK(table.at("stopped") == false);
    CHECK(table.at("inputs").at("disc_radius") == Json{0.02, 0.04});
    CHECK(table.at("inputs").at("rays") == 2000);
    REQUIRE(table.at("rows").size() == 4);
    const auto rows = csv_of(model + "--disc-radius 0.02,0.04 --ratio 0.5,0.6");
    REQUIRE(rows.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      Json own = result_of(model + "--levels 3 --disc-radius " + (i < 2 ? "0.02" : "0.04") + " --ratio " +
                           (i % 2 == 0 ? "0.5" : "0.6"));
      CHECK(table.at("rows")[i].at("inputs") == own.at("inputs"));
      CHECK(table.at("rows")[i].at("spheres").size() == 3);
      for (const std::string key : {"k", "total_time", "rebuild_time", "counts", "spheres", "parameters"})
        CHECK(table.at("rows")[i].at(key) == own.at(key));
      CHECK(number(rows[i], "total_time") == own.at("total_time").get<double>());
      CHECK(number(rows[i], "disc_tests") == own.at("counts").at("disc_tests").get<double>());
      CHECK(rows[i].at("i").empty());
    }
  }

  TEST_CASE("model: CSV of one result has a row for each sphere, each with the values common to all") {
    const Json json = result_of("model" + numbers + " --ratio 0.5");
    const auto rows = csv_of("model" + numbers + " --ratio 0.5");
    REQUIRE(rows.size() == json.at("spheres").size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const auto& [key, value] : json.at("spheres")[i].items())
        CHECK(number(rows[i], key == "i" ? key : key + "_i") == value.get<double>());
      for (const std::string key : {"k", "rebuild_time", "intersect_time", "copy_time", "order_time", "total_time"})
        CHECK(number(rows[i], key) == json.at(key).get<double>());
      CHECK(rows[i].at("cost_t") == "1");
      CHECK(rows[i].at("parameters") == "Q 0.5, k 6");
    }
    CHECK(csv_of("model" + numbers + " --ratio 0.5 --levels 0").size() == 1);
  }

  TEST_CASE("model: every technique's CSV carries every number of its JSON") {
    for (const std::string technique : {"brute-force", "sphere-cache --order none", "sphere-cache --form published",
                                        "cell-spheres", "sphere-tree", "octree", "octree --form published", "grid"}) {
      const std::string line = "model" + numbers + " --technique " + technique;
      CAPTURE(line);
      const Json json = result_of(line);
      const CsvRow row = csv_of(line).front();
      const auto check = [&](const Json& part) {
        for (const auto& [bound_key, value] : part.items()) {
          const auto& key = bound_key;
          CAPTURE(key);
          if (value.is_number()) CHECK(number(row, key) == value.get<double>());
          if (value.is_string()) CHECK(row.at(key) == value.get<std::string>());
        }
      };
      Json answer = json;
      for (const char* envelope : {"schema", "inputs", "provenance"}) answer.erase(envelope);
      check(answer);
      check(json.at("parameters"));
      if (json.contains("counts")) check(json.at("counts"));
    }
  }

  TEST_CASE("run: counted and predicted tests against Q for several radii are one table") {
    const std::string line =
        "run @uniform --samples 2000 --rays 5000 --technique sphere-cache --disc-radius 0.02,0.04 ";
    const auto rows = csv_of(line + "--ratio 0.5:0.7:0.1 --spheres max --engine plain");
    REQUIRE(rows.size() == 6);
    const auto published = csv_of(
        "model @uniform --samples 2000 --rays 5000 --disc-radius 0.02,0.04 --ratio 0.5:0.7:0.1 --form corrected");
    REQUIRE(published.size() == 6);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const std::string same : {"scene", "rays", "samples", "disc_radius", "sphere_radius", "ratio", "k"})
        CHECK(rows[i].at(same) == published[i].at(same));
      CHECK(rows[i].at("hits") == rows[i < 3 ? 0 : 3].at("hits"));
      CHECK(number(rows[i], "predicted_cull_tests") == number(published[i], "rebuild_time"));
      CHECK(number(rows[i], "predicted_disc_tests") == number(published[i], "intersect_time"));
      CHECK(number(rows[i], "tests") == number(rows[i], "cull_tests") + number(rows[i], "disc_tests"));
      CHECK(number(rows[i], "cull_tests") == doctest::Approx(number(published[i], "rebuild_time")).epsilon(0.2));
      const std::string ratio = rows[i].at("ratio");
      const Json own = result_of(
          "run @uniform --samples 2000 --rays 5000 --technique sphere-cache --spheres max "
          "--engine plain --disc-radius " +
          rows[i].at("disc_radius") + " --ratio " + ratio);
      CHECK(rows[i].at("cull_tests") == own.at("counts").at("cull_tests").dump());
      CHECK(rows[i].at("hits") == own.at("hits").dump());
    }
  }

  TEST_CASE("published, corrected and counted rows join: k is the row's own, T_R and T_I have one name") {
    const std::string workload = " @uniform --samples 2000 --rays 5000 --disc-radius 0.02 --ratio 0.5,0.65 ";
    const auto model = csv_of("model" + workload + "--form published,corrected --levels 0");
    const auto run = csv_of("run" + workload + "--technique sphere-cache --spheres max");
    REQUIRE(model.size() == 4);
    REQUIRE(run.size() == 2);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(model[i].at("k") == model[i].at("k_" + model[i].at("form")));
      for (const std::string same : {"scene", "disc_radius", "ratio", "k_published", "k_corrected"})
        CHECK(model[i].at(same) == run[i / 2].at(same));
    }
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(run[i].at("k") == run[i].at("k_corrected"));
      for (const std::string time : {"rebuild_time", "intersect_time"})
        CHECK(number(run[i], "predicted_" + time) == number(model[2 * i + 1], time));
      CHECK(run[i].at("rebuild_time") == run[i].at("cull_tests"));
      CHECK(run[i].at("intersect_time") == run[i].at("disc_tests"));
    }
    CHECK(detp("run" + workload + "--technique sphere-cache").out.find(" rebuild_time ") != std::string::npos);
  }

  TEST_CASE("several techniques and engines in one run are rows of one table, and its text is aligned") {
    const std::string line = "run @cornell --rays 1000 --technique grid,sphere-tree,photon-map --engine plain,simd";
    const auto rows = csv_of(line + " --field photons");
    REQUIRE(rows.size() == 6);
    CHECK(rows[0].at("technique") == "grid");
    CHECK(rows[3].at("technique") == "sphere-tree");
    CHECK(rows[3].at("engine") == "simd");
    CHECK(rows[0].at("hits") == rows[3].at("hits"));
    CHECK(rows[4].at("predicted_tests").empty());
    const std::string text = detp("model" + numbers + " --ratio 0.5:0.7:0.1").out;
    std::istringstream lines(text.substr(text.find("\n\n") + 2));
    std::vector<std::string> table;
    for (std::string row; std::getline(lines, row);) table.push_back(row);
    REQUIRE(table.size() == 4);
    for (const std::string& row : table) CHECK(row.size() <= table[0].size());
    CHECK(table[3].find("Q 0.7, k 12") != std::string::npos);
    CHECK(text.find("disc_radius      0.02\n") != std::string::npos);
  }

  TEST_CASE("a stopped table has its rows so far, says so, and ends with code 3") {
    const std::string model = "model" + numbers + " --spheres best --ratio 0.9:0.99:0.00001";
    const Finished text =
        stopped_in_time(model, [](const Finished& one) { return one.out.find(" of 9001 rows") != std::string::npos; });
    CHECK(text.code == 3);
    CHECK(text.out.find(" of 9001 rows") != std::string::npos);
    const Finished json =
        stopped_in_time(model + " --format json", [](const Finished& one) { return one.json().contains("rows"); });
    CHECK(json.code == 3);
    CHECK(json.json().at("stopped") == true);
    CHECK(json.json().at("rows").size() < 9001);
    CHECK(json.json().at("rows").size() > 0);
    const Finished run = stopped_in_time(
        "run @uniform --samples 3000 --rays 3000 --technique brute-force --engine plain --disc-radius 0.001:1:0.001 "
        "--format csv",
        [](const Finished& one) { return one.out.find("cull_tests,") != std::string::npos; });
    CHECK(run.code == 3);
    const auto rows = csv_rows(run.out);
    CHECK(rows.size() < 1000);
    for (const CsvRow& row : rows) CHECK(row.at("stopped") == (&row == &rows.back() ? row.at("stopped") : "false"));
  }

  TEST_CASE("-o is short for --output") {
    const support::ScratchFolder folder;
    const std::string path = folder.path("table.csv");
    CHECK(detp(words("model" + numbers + " --format csv -o") + Arguments{path}).code == 0);
    CHECK(support::content_of(path) == detp("model" + numbers + " --format csv").out);
  }

  TEST_CASE("scene: CSV is one row with the values of JSON, including effects") {
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
