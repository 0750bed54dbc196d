#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "support/command.hpp"
#include "support/csv_answer.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("--ratio counts sphere caches of these Q, --form shows one form of each claim; both forms are judged" *
            doctest::test_suite("long")) {
    const std::string line =
        "validate --samples 500 --rays 32000 --disc-radius 0.05 --experiments sphere-cache --ratio 0.5 ";
    const Json both = result_of(line);
    CHECK(both.at("inputs").at("ratio") == Json{0.5});
    CHECK(both.at("claims").back().at("id") == "rebuild-time-structural-0.5.corrected");
    CHECK(detp(line).out.find("T_R per ray, t = 1: Q = 0.5\n") != std::string::npos);
    for (const std::string form : {"published", "corrected"}) {
      Json shown = Json::array();
      for (Json claim : both.at("claims"))
        if (claim.at("form") == form) shown.push_back(claim.at("id"));
      const Json one = result_of(line + "--form " + form);
      Json ids = Json::array();
      for (const Json& claim : one.at("claims")) ids.push_back(claim.at("id"));
      CHECK(ids == shown);
      CHECK(ids.size() >= 4);
      CHECK(one.at("summary") == both.at("summary"));
    }
    CHECK(result_of(line + "--ratio 0.4:0.6:0.1,0.5").at("inputs").at("ratio") == Json{0.5, 0.4, 0.6});
    check_refused({{"validate --ratio 0", "--ratio must be between 0 and 1"}, {"validate --ratio 1.5", "(got 1.5)"}});
  }

  TEST_CASE("--experiments leaves out all other experiments") {
    const Json json = result_of("validate @cornell --samples 300 --rays 3200 --experiments lines,effects");
    bool effects = false;
    bool lines = false;
    for (const Json& claim : json.at("claims")) {
      const std::string id = claim.at("id");
      effects = effects || id.starts_with("effects.");
      lines = lines || id.starts_with("sphere-hit-probability");
      CHECK_FALSE(id.starts_with("choice."));
      CHECK_FALSE(id.starts_with("octree"));
    }
    CHECK(effects);
    CHECK(lines);
    check_refused({{"validate --experiments octrees", "choice,effects,lines"}});
  }

  TEST_CASE("on a scene, choose's predictions are claims too, and exit code 1 means that one is refuted" *
            doctest::test_suite("long")) {
    // Photon paths in a box: the closed forms of choose predict the tests and hits of isotropic lines, about half of the
    // counted numbers.
    const std::string scene = " @cornell --samples 300 --rays 9000 --disc-radius 4%";  // photons of one power
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
      const Json effects = finished.json().at("effects");  // kept: a loop over a part of a temporary would outlive it
      for (const Json& effect : effects) {
        CHECK_FALSE(effect.at("reason").get<std::string>().empty());
        CHECK((quantity.find(effect.at("name").get<std::string>()) != std::string::npos) == effect.at("on"));
      }
    }
    CHECK(finished.code == (refuted ? 1 : 0));
    CHECK(refuted);
    // The summary counts the claims, and names those of the choice that are refuted.
    const Json summary = finished.json().at("summary");
    const std::string chosen = summary.at("choice").at("technique");
    Json refuted_claims = Json::array();
    int agree = 0;
    for (const Json& claim : claims) {
      const bool corrected = claim.at("form") == "corrected";
      agree += corrected && claim.at("verdict") == "agrees" ? 1 : 0;
      if (claim.at("id").get<std::string>().starts_with("choice." + chosen + ".") && claim.at("verdict") == "refuted")
        refuted_claims.push_back(claim.at("id"));
    }
    CHECK(summary.at("corrected").at("agrees") == agree);
    CHECK(summary.at("choice").at("refuted_claims") == refuted_claims);
    CHECK(summary.at("choice").at("technique") == claims[0].at("technique"));
    const std::string text = detp("validate" + scene).out;
    CHECK(text.starts_with("answer    "));
    const std::size_t table = text.find("\nclaim ");
    const std::size_t choice_line = text.find("\nchoice    " + chosen + ", ");
    CHECK(choice_line < table);
    for (const char* word : {"\nothers    predictions refuted: ", "sphere-cache: ", " refuted, as documented: "})
      CHECK_MESSAGE(text.find(word) < table, word);
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

  TEST_CASE("if nothing was hit, unknown values are left out of JSON and CSV" * doctest::test_suite("long")) {
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

  TEST_CASE("JSON, CSV and text say which effects the predictions have, and why" * doctest::test_suite("long")) {
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
    CHECK(text.find("\neffects   on: uneven rays (by hand); off: facing, ") != std::string::npos);
    CHECK(detp("validate --samples 1 --rays 1 --format json").json().at("effects").size() == json.at("effects").size());
  }

  TEST_CASE("controls are caught, refuted published forms are documented" * doctest::test_suite("long")) {
    const std::string line = "validate --samples 200 --rays 3200";
    const Finished finished = detp(line + " --format json");
    CHECK(finished.code == 0);  // published forms are refuted, but no corrected one
    const Json json = finished.json();
    int documented = 0;
    for (const Json& claim : json.at("claims")) {
      CAPTURE(claim.at("id").get<std::string>());
      const std::string control = claim.at("control").at("verdict");
      CHECK((control == "caught" || control == "undecided"));
      documented += claim.at("documented") == true ? 1 : 0;
      if (claim.at("documented") == true) {
        CHECK(claim.at("form") == "published");
        CHECK(claim.at("verdict") == "refuted");
      }
    }
    CHECK(documented >= 4);  // the number of spheres, rebuilds and both times of the sphere cache
    const Json& summary = json.at("summary");
    CHECK(summary.at("corrected").at("refuted") == 0);
    CHECK(summary.at("published").at("documented") == documented);
    CHECK(summary.at("controls").at("caught").get<int>() > 40);
    CHECK(summary.at("controls").at("missed") == 0);
    CHECK_FALSE(summary.contains("choice"));
    int caught = 0;
    for (const CsvRow& row : csv_rows(detp(line + " --format csv").out)) {
      caught += row.at("control_verdict") == "caught" ? 1 : 0;
      CHECK(row.at("control_verdict") != "refuted");
      documented -= row.at("documented") == "true" ? 1 : 0;
    }
    CHECK(caught == summary.at("controls").at("caught").get<int>());
    CHECK(documented == 0);
    const std::string text = detp(line).out;
    CHECK(text.starts_with("answer    none of the "));
    const std::string summary_text = std::regex_replace(text.substr(0, text.find("\nclaim ")), std::regex("\\s+"), " ");
    for (const char* word :
         {" published ", "refuted, as documented: sphere-cache: sphere-count, rebuilds", " controls "})
      CHECK_MESSAGE(summary_text.find(word) != std::string::npos, word);
    CHECK(text.find("  refuted, as documented  caught\n") != std::string::npos);
  }

  TEST_CASE("the sweep's options are refused without a sweep") {
    check_refused({{"validate --resume", "--resume needs the --checkpoint"},
                   {"validate --checkpoint x.json", "--effort thorough"},
                   {"validate --most-samples 1000", "--effort thorough"},
                   {"validate --sweep-rows rows.csv", "--effort thorough"},
                   {"validate --effort thorough --resume", "--checkpoint"},
                   {"validate @tree --effort thorough", "takes no scene"},
                   {"validate --effort thorough --most-samples 0", "--most-samples"},
                   {"validate --effort great", "default,thorough"}});
  }

  TEST_CASE("errors to reach are checked before any work") {
    check_refused({{"validate --until-relative-error 0", "relative error"},
                   {"validate --until-relative-error 5%% --quiet", "--until-relative-error"},
                   {"validate --until-relative-error 1% --confidence 2", "confidence"},
                   {"validate --until-relative-error 1% --min-lines 1k --max-lines 100", "least number of lines"},
                   {"validate --max-lines 1M", "--until-relative-error"}});
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
  TEST_CASE("counts go on until each observed value is known as well as asked, or say what is missing") {
    const std::string command =
        "validate --rays 20k --samples 300 --disc-radius 4% --format json --until-relative-error ";
    const Finished finished = detp(command + "6%");
    CHECK(finished.code == 0);
    const Json json = finished.json();
    CHECK(json.at("inputs").at("until_relative_error") == 0.06);
    for (const Json& claim : json.at("claims")) {
      CAPTURE(claim.at("id"));
      CHECK(claim.at("reached") == true);
      CHECK(claim.at("relative_error").get<double>() <= 0.06);
      CHECK(claim.at("more_lines").is_null());
    }
    const Finished limited = detp(command + "0.1% --max-lines 20k");
    CHECK(limited.code == 3);
    CHECK(std::ranges::any_of(limited.json().at("claims"), [](const Json& claim) {
      return claim.at("reached") == false && claim.at("more_lines").get<double>() > 20'000;
    }));
    CHECK(limited.json().at("stopped") == false);
    const Finished timed = detp(command + "0.1% --time-limit 1");
    CHECK(timed.code == 3);
    CHECK(timed.json().at("stopped") == true);
  }

  TEST_CASE("files of discs and rays are validated with the rays that they contain") {
    const support::ScratchFolder folder;
    const std::string discs = folder.path("discs.csv");
    const std::string rays = folder.path("rays.csv");
    // Enough samples that the lists of one set are close to their mean over all sets, which is what is predicted.
    REQUIRE(detp("scene @uniform --samples 2000 --rays 3200 --disc-radius 6% --quiet --write-discs " + discs +
                 " --write-rays " + rays)
                .code == 0);
    const Finished finished =
        detp("validate --experiments choice --format json --discs " + discs + " --ray-file " + rays);
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
