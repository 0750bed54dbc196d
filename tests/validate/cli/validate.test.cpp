#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "support/command.hpp"
#include "support/csv_answer.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("on a scene, choose's predictions are claims too, and exit code 1 means that one is refuted" *
            doctest::test_suite("long")) {
    // Photon paths in a box: the closed forms of choose predict the tests and hits of isotropic lines, about half of the
    // counted numbers.
    const std::string scene = " @cornell --samples 300 --rays 3200 --disc-radius 4%";
    const Finished finished = detp("validate" + scene + " --format json");
    const Json claims = finished.json().at("claims");
    std::map<std::string, Json> by_id;
    bool refuted = false;
    for (const Json& claim : claims) {
      by_id[claim.at("id")] = claim;
      refuted = refuted || (claim.at("form") == "corrected" && claim.at("verdict") == "refuted");
      for (const char* key : {"source", "tolerance", "standard_error", "detectable", "control"})
        CHECK(claim.contains(key));
    }
    CHECK(finished.json().at("warnings").empty());
    for (const char* id : {"effects.tests.corrected", "effects.hits.corrected"}) {
      const std::string quantity = by_id.at(id).at("quantity");
      for (const Json& effect : finished.json().at("effects")) {
        CHECK_FALSE(effect.at("reason").get<std::string>().empty());
        CHECK((quantity.find(effect.at("name").get<std::string>()) != std::string::npos) == effect.at("on"));
      }
    }
    CHECK(finished.code == (refuted ? 1 : 0));
    CHECK(refuted);
    const Json choice = result_of("choose --rigor estimate" + scene);
    for (const Json& candidate : choice.at("candidates")) {
      const std::string technique = candidate.at("technique");
      CHECK(by_id.at("choice." + technique + ".disc-tests.corrected").at("predicted") ==
            candidate.at("predicted").at("disc_tests"));
      CHECK(by_id.at("choice." + technique + ".hits.corrected").at("predicted") ==
            candidate.at("predicted").at("hits"));
    }
    for (const char* id : {"rebuilds", "rebuild-time", "intersect-time", "octree-tests-per-line"})
      for (const char* form : {".published", ".corrected"}) CHECK(by_id.contains(std::string(id) + form));
    for (const char* id : {"cell-spheres-sphere-tests", "cell-spheres-disc-tests", "sphere-tree-sphere-tests",
                           "sphere-tree-disc-tests", "octree-tests-structural", "hits-per-line"})
      CHECK(by_id.contains(std::string(id) + ".corrected"));
  }

  TEST_CASE("if nothing was hit, unknown values are left out of JSON and CSV") {
    const std::string sparse = "validate --samples 1 --rays 1";
    const Finished json = detp(sparse + " --format json");
    CHECK(json.err.empty());
    CHECK((json.code == 0 || json.code == 1));
    const Json result = json.json();
    bool some_unknown = false;
    for (const Json& claim : result.at("claims"))
      if (claim.at("standard_error").is_null()) {
        some_unknown = true;
        CHECK(claim.at("detectable").is_null());
        CHECK(claim.at("verdict") == "undecided");
      }
    CHECK(some_unknown);
    for (const std::string format : {"csv", "text"})
      CHECK_FALSE(has_no_number(detp(sparse + " --format " + format).out));
  }

  TEST_CASE("JSON, CSV and text say which effects the predictions have, and why") {
    const std::string sparse = "validate @cornell --samples 20 --rays 100 --effects uneven-rays";
    const Json json = detp(sparse + " --format json").json();
    const std::vector<CsvRow> rows = csv_rows(detp(sparse + " --format csv").out);
    REQUIRE_FALSE(rows.empty());
    for (const Json& effect : json.at("effects")) {
      std::string column = effect.at("name");
      std::replace(column.begin(), column.end(), ' ', '_');
      CHECK(rows.front().at(column) == effect.at("on").dump());
      if (column == "uneven_rays") CHECK(effect.at("on") == true);
      if (column == "finite_paths") CHECK(effect.at("reason") == "switched off by --effects uneven-rays");
    }
    const std::string text = detp(sparse).out;
    CHECK(text.starts_with("effects   on: uneven rays (by hand); off: facing, "));
    CHECK(detp("validate --samples 1 --rays 1 --format json").json().at("effects").size() == json.at("effects").size());
  }

  TEST_CASE("the sweep's options are refused without a sweep") {
    check_refused({{"validate --resume", "--effort thorough"},
                   {"validate --checkpoint x.json", "--effort thorough"},
                   {"validate --most-samples 1000", "--effort thorough"},
                   {"validate --sweep-rows rows.csv", "--effort thorough"},
                   {"validate --effort thorough --resume", "--checkpoint"},
                   {"validate @tree --effort thorough", "takes no scene"},
                   {"validate --effort thorough --most-samples 0", "--most-samples"},
                   {"validate --effort great", "default,thorough"}});
  }

  TEST_CASE("a time limit before the first verdict ends with code 3 and the results so far") {
    const Finished finished = detp("validate --time-limit 0.2 --format json");
    CHECK(finished.code == 3);
    CHECK(finished.err.empty());
    CHECK(finished.json().at("stopped") == true);
    CHECK(finished.json().at("claims").is_array());
  }
}

TEST_SUITE("statistical") {  // because it takes long
  TEST_CASE("files of discs and rays are validated with the rays that they contain") {
    const support::ScratchFolder folder;
    const std::string discs = folder.path("discs.csv");
    const std::string rays = folder.path("rays.csv");
    // Enough samples that the lists of one set are close to their mean over all sets, which is what is predicted.
    REQUIRE(detp("scene @uniform --samples 2000 --rays 3200 --disc-radius 6% --quiet --write-discs " + discs +
                 " --write-rays " + rays)
                .code == 0);
    const Finished finished = detp("validate --format json --discs " + discs + " --ray-file " + rays);
    CHECK((finished.code == 0 || finished.code == 1));
    const Json json = finished.json();
    int of_the_choice = 0;
    for (const Json& claim : json.at("claims"))
      if (claim.at("id").get<std::string>().starts_with("choice.")) {
        ++of_the_choice;
        CHECK(claim.at("lines") == 3200);
        CHECK(claim.at("verdict") != "refuted");
      }
    CHECK(of_the_choice >= 15);
  }
}

}  // namespace detp::support
