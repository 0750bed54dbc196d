#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "detp/sim/base/threads.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/calibration/calibration_file.hpp"
#include "support/attempts.hpp"
#include "support/command.hpp"
#include "support/sealed.hpp"

namespace detp::support {
namespace {

const std::string question = "choose --rays 1000 --samples 1000 --disc-radius 0.01 --scene-side 2 --format json";

/// Sets $XDG_CACHE_HOME for the programs that a test starts.
class CacheFolder {
 public:
  explicit CacheFolder(const std::string& path) {
    static_cast<void>(detp("--version"));  // sets the folder of all other tests
    REQUIRE(::setenv("XDG_CACHE_HOME", path.c_str(), 1) == 0);
  }
  ~CacheFolder() { ::setenv("XDG_CACHE_HOME", "/dev/null", 1); }
  CacheFolder(const CacheFolder&) = delete;
  CacheFolder& operator=(const CacheFolder&) = delete;
};

}  // namespace

TEST_SUITE("long") {
  TEST_CASE("calibrate saves the costs of this machine, and choose uses them") {
    const ScratchFolder folder;
    const CacheFolder cache(folder.path("cache"));
    const Json before = detp(question).json();
    const auto costs_said = [](const Json& json) { return json.at("unit_costs").get<std::string>(); };
    CHECK(costs_said(before).find("built in, scaled by a probe") != std::string::npos);
    const Finished finished = detp("calibrate --seconds 0.1 --format json");
    CHECK(finished.code == 0);
    const Json calibrated = finished.json();
    CHECK(calibrated.at("schema").at("name") == "detp.calibrate");
    CHECK(calibrated.at("left_out_median_error").get<double>() > 0);
    CHECK(calibrated.at("key").at("threads").get<int>() > 0);
    CHECK(calibrated.at("costs").at("simd").at("box-tree").size() > 3);
    const Json& plain = calibrated.at("costs").at("plain");
    CHECK(plain.at("box-tree") != calibrated.at("costs").at("simd").at("box-tree"));
    CHECK(plain.at("sphere-tree") == calibrated.at("costs").at("simd").at("sphere-tree"));
    if (calibrated.at("key").at("threads") > 1) {
      CHECK(calibrated.at("threads").at("simd").contains("box-tree"));
      CHECK_FALSE(calibrated.at("threads").at("simd").contains("sphere-tree"));  // one thread searches it
      // With one core there is nothing to fit, and on busy cores threads may seem to gain nothing.
      if (calibrated.at("thread_fits").empty() && sim::thread_count(0) > 1)
        CHECK(in_attempts(4, [&] {  // saved elsewhere: the first one stays in use
          const std::string elsewhere = " --output " + folder.path("again.json");
          return !detp("calibrate --seconds 0.1 --format json" + elsewhere).json().at("thread_fits").empty();
        }));
    }
    CHECK(calibrated.at("saved") == folder.path("cache/detp/calibration.json"));
    const Json after = detp(question).json();
    CHECK(after.at("unit_costs").get<std::string>().find("of this machine, calibrated") != std::string::npos);
    CHECK(after.at("inputs").at("unit_costs").at("box-tree") == calibrated.at("costs").at("simd").at("box-tree"));
    CHECK(detp(question + " --engine plain").json().at("inputs").at("unit_costs").at("box-tree") ==
          plain.at("box-tree"));
    CHECK(costs_said(detp(question + " --calibration none").json()).find("built in, measured on another") !=
          std::string::npos);
  }

  TEST_CASE("--output saves the calibration elsewhere, and --calibration uses that file; so is the result in JSON") {
    const ScratchFolder folder;
    const std::string path = folder.path("mine.json");
    const Finished finished = detp("calibrate --seconds 0.1 --format json --output " + path);
    CHECK(finished.code == 0);
    CHECK(finished.json().at("saved") == path);
    for (const std::string& calibration : {path, folder.file("result.json", finished.out)}) {
      CAPTURE(calibration);
      const Finished chosen = detp(question + " --calibration " + calibration);
      CHECK(chosen.code == 0);
      CHECK(chosen.json().at("unit_costs").get<std::string>().find("of this machine") != std::string::npos);
      CHECK(detp("run @uniform --samples 100 --rays 100 --calibration " + calibration).code == 0);
    }
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a broken or foreign stored calibration is not used, with a word of why; a named one is refused" *
            doctest::test_suite("long")) {
    const ScratchFolder folder;
    const std::string path = folder.path("cache/detp/calibration.json");
    validate::Calibration calibration;
    calibration.plain = validate::built_in_unit_costs(Engine::plain);
    calibration.simd = validate::built_in_unit_costs();
    validate::write_calibration(path, calibration);
    Json foreign = Json::parse(content_of(path));
    foreign["key"]["cpu"] = "another";
    Json older = Json::parse(content_of(path));
    older["key"]["cost_model"] = 2;
    const CacheFolder cache(folder.path("cache"));
    Json costless = Json::parse(content_of(path));
    costless["costs"] = {{"simd", Json::object()}, {"plain", Json::object()}};
    Json vast = Json::parse(content_of(path));
    vast["left_out_median_error"] = 1e308;
    const std::string of_elsewhere = support::sealed_calibration(foreign);
    for (const std::string& content :
         {of_elsewhere, older.dump(), costless.dump(), vast.dump(), foreign.dump(), std::string("{")}) {
      CAPTURE(content);
      folder.file("cache/detp/calibration.json", content);
      const Finished automatic = detp(question);
      CHECK(automatic.code == 0);
      CHECK(automatic.err.find("not used") != std::string::npos);
      CHECK(automatic.json().at("unit_costs").get<std::string>().find("built in") != std::string::npos);
      const Finished named = detp(question + " --calibration " + path);
      CHECK(named.code == 2);
      const char* const why = content == "{"               ? "is not a calibration"
                              : content == older.dump()    ? "version 2 of the cost model"
                              : content == costless.dump() ? "it has no unit costs of brute-force"
                              : content == vast.dump()     ? "left_out_median_error must be at most 100"
                              : content == foreign.dump()  ? "does not fit its checksum"
                                                           : "its cpu is another";
      CHECK(named.err.find(why) != std::string::npos);
    }
    CHECK(detp(question + " --calibration " + folder.path("missing.json")).code == 2);
  }

  TEST_CASE("choose and run warn of a doubtful calibration, in one line") {
    const ScratchFolder folder;
    validate::Calibration calibration;
    calibration.plain = validate::built_in_unit_costs(Engine::plain);
    calibration.simd = validate::built_in_unit_costs();
    const auto errors_of = [&](const std::string& command) {
      const std::string path = folder.file("mine.json", validate::calibration_text(calibration));
      const Finished finished = detp(command + " --calibration " + path);
      CHECK(finished.code == 0);
      return finished.err;
    };
    for (const std::string& command : {question, std::string("run @uniform --samples 100 --rays 100 --verbose")}) {
      CAPTURE(command);
      calibration.processor_share = 1;
      CHECK(errors_of(command).find("doubtful") == std::string::npos);
      calibration.processor_share = 0.5;
      const std::string errors = errors_of(command);
      CHECK(errors.find("predicted seconds are doubtful") != std::string::npos);
      CHECK(errors.find("other programs took 50 % of the time") != std::string::npos);
      CHECK(errors.find('\n') == errors.size() - 1);
    }
    CHECK(errors_of("run @uniform --samples 100 --rays 100").empty());  // it shows no predicted seconds
  }

  TEST_CASE("calibrate takes no time of zero") { CHECK(detp("calibrate --seconds 0").code == 2); }
}

}  // namespace detp::support
