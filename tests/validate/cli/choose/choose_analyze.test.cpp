#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "support/command.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("--analyze adds counts, measured times and the regret" * doctest::test_suite("long")) {
    const std::string line = "choose @cornell --rays 1000 --analyze";
    const Json json = result_of(line);
    CHECK(json.at("regret").get<double>() >= 0);
    CHECK(json.at("stopped") == false);
    std::uint64_t hits = 0;
    const Json& predicted = json.at("candidates")[0];
    double fastest = predicted.at("measured_seconds");
    const double choice = fastest;
    for (const char* key : {"technique", "parameters", "predicted_seconds"})
      CHECK(json.at("predicted_choice").at(key) == predicted.at(key));
    for (const char* key : {"technique", "parameters", "measured_seconds"})
      CHECK(json.at("choice").at(key) == json.at("best_measured").at(key));
    int run = 0;
    std::set<std::string> techniques;
    for (const Json& candidate : json.at("candidates")) {
      CAPTURE(candidate.dump());
      techniques.insert(candidate.at("technique"));
      run += candidate.contains("measured_seconds") || candidate.contains("given_up_after_seconds") ? 1 : 0;
      if (candidate.contains("not_run")) continue;
      CHECK(candidate.at("measured_seconds").get<double>() > 0);
      CHECK(candidate.at("measured_seconds").get<double>() >=
            json.at("best_measured").at("measured_seconds").get<double>());
      fastest = std::min(fastest, candidate.at("measured_seconds").get<double>());
      const std::uint64_t found = candidate.at("counted").at("hits");
      CHECK(found > 0);
      if (hits > 0) CHECK(found == hits);
      hits = found;
    }
    CHECK(json.at("regret").get<double>() == doctest::Approx(choice / fastest - 1));
    CHECK((json.at("regret_error").get<double>() > 0) == (json.at("regret").get<double>() > 0));
    CHECK(json.at("tried") == run);
    for (const Technique technique : all_techniques)
      CHECK(techniques.contains(std::string(name(technique))) == record_of(technique).exact);
    for (const Json& missed : json.at("missed"))
      if (missed.contains("seconds_ratio"))
        CHECK(missed.at("seconds_ratio").get<double>() ==
              doctest::Approx(missed.at("counts_ratio").get<double>() * missed.at("unit_costs_ratio").get<double>()));
    for (const std::string format : {"text", "csv", "json"})
      CHECK_FALSE(has_no_number(detp(line + " --format " + format).out));
  }

  TEST_CASE("with --analyze the measured winner is the choice, and the prediction's errors are reported" *
            doctest::test_suite("long")) {
    // With these unit costs, brute force has by far the shortest predicted time.
    const std::string line =
        "choose @uniform --samples 5000 --rays 5000 --disc-radius 1% --analyze --threads 1 "
        "--costs t=1,u=1e-18,w=1,v=1,n=1,c=1,b=1,s=1,r=1";
    const Json json = result_of(line);
    CHECK(json.at("predicted_choice").at("technique") == "brute-force");
    CHECK(json.at("choice").at("technique") != "brute-force");
    CHECK(json.at("choice").at("technique") == json.at("best_measured").at("technique"));
    CHECK(json.at("regret").get<double>() > 1);
    CHECK(json.at("tried").get<int>() >= 10);
    CHECK(json.at("missed").at(0).at("counts_ratio").get<double>() == doctest::Approx(1));
    CHECK(json.at("missed").at(0).at("unit_costs_ratio").get<double>() < 1e-3);
    for (const std::string detail : {"", " --verbose"}) {
      const std::string text = detp(line + detail).out;
      CHECK(text.starts_with("choice    "));  // the fastest of two runs may differ
      CHECK_FALSE(text.starts_with("choice    brute-force"));
      for (const char* said : {", the fastest of ", "\nregret    ", ": brute-force, the predicted choice, takes",
                               "\npredicted ", " too low: counts right within 1 %, unit costs "})
        CHECK_MESSAGE(text.find(said) != std::string::npos, said, text);
      CHECK(text.find("within the noise") == std::string::npos);
      CHECK(text.find("\ngain      testing every ray with every disc would take") != std::string::npos);
      CHECK((text.find("\nmissed    brute-force: predicted") != std::string::npos) == !detail.empty());
    }
    const std::string table = detp(line).out;
    CHECK(table.find("<- fastest") != std::string::npos);
    CHECK(table.find("<- predicted choice") != std::string::npos);
    CHECK(table.find("<- fastest") < table.find("\nscene     "));
    CHECK(std::count(table.begin(), table.end(), '\n') < 30);
  }

  TEST_CASE("an analysis that is stopped says after how many candidates, and ends with code 3") {
    const std::string line =
        "choose @uniform --samples 100000 --rays 100000 --threads 1 --analyze --costs "
        "t=1,u=1e-18,w=1,v=1,n=1,c=1,b=1,s=1,r=1";  // starts with brute force, which takes more than 1 s
    const Finished finished =
        stopped_in_time(line, [](const Finished& one) { return one.out.starts_with("stopped   after 0 of "); });
    CHECK(finished.code == 3);
    CHECK(finished.out.starts_with("stopped   after 0 of "));
    CHECK(finished.out.find("\ntried     0 of ") != std::string::npos);
    CHECK(finished.out.find("\nchoice    brute-force") != std::string::npos);
    const Finished json =
        stopped_in_time(line + " --format json", [](const Finished& one) { return one.json().contains("tried"); });
    CHECK(json.code == 3);
    CHECK(json.json().at("stopped") == true);
    CHECK(json.json().at("tried") == 0);
    CHECK_FALSE(json.json().contains("best_measured"));
    CHECK_FALSE(json.json().contains("regret"));
  }

  TEST_CASE("structural rigor predicts from rays of the same kind, lines or segments" * doctest::test_suite("long")) {
    const std::string uniform = "choose @uniform --samples 2000 --rays 20000 --disc-radius 2%";
    const Json structural = result_of(uniform + " --rigor structural --analyze");
    CHECK(structural.at("rigor") == "structural");
    int compared = 0;
    int with_error = 0;
    for (const Json& candidate : structural.at("candidates")) {
      if (candidate.contains("predicted_seconds_error") && candidate.at("predicted_seconds_error") > 0) ++with_error;
      if (!candidate.contains("counted") || !candidate.contains("predicted")) continue;
      const auto tests = [](const Json& counts) {
        return counts.at("cull_tests").get<double>() + counts.at("disc_tests").get<double>();
      };
      CHECK(tests(candidate.at("predicted")) == doctest::Approx(tests(candidate.at("counted"))).epsilon(0.15));
      ++compared;
    }
    CHECK(compared >= 5);
    CHECK(with_error >= 1);
    const std::string paths = "choose @tree --samples 5000 --rays 1000 --disc-radius 1% --rigor structural";
    CHECK(result_of(paths).at("rigor") == "structural");
    CHECK(detp(paths).out.find("segments of the field, not those of the run") != std::string::npos);
  }

  TEST_CASE("measure rigor runs the candidates; its time limit is not an error, unless nothing was tried") {
    const std::string measure =
        "choose @uniform --samples 5000 --rays 1e5 --disc-radius 1% --rigor measure --format json";
    const Finished limited = stopped_in_time(measure, [](const Finished&) { return false; });
    CHECK(limited.code == 0);
    const Json json = limited.json();
    CHECK(json.at("rigor") == "measure");
    CHECK(json.at("stopped") == false);
    CHECK(json.at("choice").contains("measured_seconds"));
    CHECK(json.at("tried") >= 1);
    const Finished nothing = detp(measure + " --time-limit 1e-6");
    CHECK(nothing.code == 3);
    CHECK(nothing.json().at("stopped") == true);
  }

  TEST_CASE("the default is a pilot; each candidate has an error, the others are ruled out or not examined") {
    const Json json = result_of("choose @tree --samples 20000 --rays 20000 --disc-radius 1%");
    CHECK(json.at("rigor") == "pilot");
    CHECK(json.at("choice").at("predicted_seconds_error") > 0);
    CHECK(json.at("candidates")[0].at("could_still_win") == true);
    CHECK(json.at("choosing_seconds").at("evidence_shown").get<double>() > 0);
    CHECK(json.at("choosing_seconds").at("total") == json.at("choosing_seconds").at("pilot"));  // without tips
    CHECK(json.at("choosing_share") > 0);
    CHECK(json.at("ruled_out").size() + json.at("not_examined").size() == 8);
    CHECK(result_of("choose --rays 10 --samples 10 --disc-radius 0.1 --scene-side 1").at("rigor") == "estimate");
  }

  TEST_CASE("--threads is a cap: choose names each candidate's number of threads, and run uses the choice's") {
    const std::string scene = " @uniform --samples 2000 --rays 2000 --disc-radius 2% --calibration none";
    const Json alone = result_of("choose" + scene + " --threads 1");
    CHECK(alone.at("choice").at("threads") == 1);
    for (const Json& candidate : alone.at("candidates")) CHECK(candidate.at("threads") == 1);
    const Json more =
        result_of("choose --rays 1e7 --samples 2000 --disc-radius 2% --scene-side 1 --calibration none --threads 2");
    for (const Json& candidate : more.at("candidates"))
      CHECK(candidate.at("threads").get<int>() <= (candidate.at("technique") == "sphere-tree" ? 1 : 2));
    CHECK(detp("choose" + scene + " --verbose").out.find("threads") != std::string::npos);
    CHECK(detp("choose" + scene + " --format csv").out.find(",engine,threads,") != std::string::npos);
    CHECK(result_of("run" + scene + " --threads 1").at("threads") == 1);
    const Json chosen = result_of("choose" + scene + " --threads 2");
    CHECK(result_of("run" + scene + " --threads 2").at("threads") == chosen.at("choice").at("threads"));
    CHECK(result_of("run" + scene + " --threads 2 --technique grid").at("threads") == 2);
  }

  TEST_CASE("--engine plain chooses among plain searches, by closed forms and costs of its own, and runs them" *
            doctest::test_suite("long")) {
    const std::string scene = " @uniform --samples 2000 --rays 20000 --disc-radius 2% --calibration none";
    const Json simd = result_of("choose" + scene);
    const Json plain = result_of("choose" + scene + " --engine plain --analyze --threads 1");
    CHECK(simd.at("engine") == "simd");
    CHECK(plain.at("engine") == "plain");
    CHECK(plain.at("rigor") == "estimate");
    CHECK(plain.at("inputs").at("unit_costs").at("box-tree") != simd.at("inputs").at("unit_costs").at("box-tree"));
    for (const Json& candidate : plain.at("candidates")) {
      if (candidate.at("technique") != "box-tree" || !candidate.contains("counted")) continue;
      const Json& parameters = candidate.at("parameters");
      const Json run = result_of(fmt::format("run{} --engine plain --technique box-tree --fan-out {} --leaf {}", scene,
                                             parameters.at("fan_out").get<int>(), parameters.at("leaf").get<int>()));
      CHECK(candidate.at("counted") == run.at("counts"));
      break;
    }
    const Json run = result_of("run" + scene + " --engine plain --threads 1");
    CHECK(run.at("engine") == "plain");
    CHECK(run.at("technique") == plain.at("predicted_choice").at("technique"));
    CHECK(run.at("predicted_seconds") == plain.at("predicted_choice").at("predicted_seconds"));
    check_refused({{"choose" + scene + " --engine plain --rigor pilot", "--rigor estimate"},
                   {"choose" + scene + " --engine fast", "--engine"}});
  }
}

}  // namespace detp::support
