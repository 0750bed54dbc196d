#include "detp/validate/report/report.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "detp/sim/base/stopped.hpp"

namespace detp::validate {
namespace {

/// As commands answer, without most of what they say.
Json made_up_answer(const std::vector<std::string>& words) {
  if (words.front() == "accuracy") throw std::invalid_argument("it has no lights");
  Json answer{{"stopped", false}, {"warnings", {"a warning"}}};
  if (words.front() == "scene") answer.update({{"samples", 100}, {"rays", 1000}, {"disc_radius", 0.5}});
  return answer;
}

}  // namespace

TEST_SUITE("report") {
  TEST_CASE("a report asks other commands, in the words of a command line") {
    std::vector<std::vector<std::string>> asked;
    const auto ask = [&](const std::vector<std::string>& words) {
      asked.push_back(words);
      return made_up_answer(words);
    };
    ReportRequest request{.scene = "my scene.obj"};
    request.rays = 1000;
    request.disc_radius = "4%";
    request.quick = true;
    const Json report = answer(request, ask);
    REQUIRE(asked.size() == 6);
    CHECK(asked[0] == std::vector<std::string>{"scene", "my scene.obj", "--rays", "1000", "--disc-radius", "4%"});
    CHECK(asked[4] == std::vector<std::string>{"choose", "my scene.obj", "--map", "--rays", "10,100,1000,3000",
                                               "--disc-radius", "0.125,0.25,0.5,1,2"});
    CHECK(report["parts"][0]["command"] == "detp scene 'my scene.obj' --rays 1000 --disc-radius 4%");
    CHECK(report["parts"][0]["forecast_seconds"].is_null());
    CHECK(report["parts"][3]["not_made"] == "it has no lights");
    CHECK_FALSE(report["parts"][3].contains("answer"));
    CHECK(report["warnings"].size() == 1);
    CHECK(report["inputs"]["target_noise"] == "5%");
    CHECK(report["stopped"] == false);
  }

  TEST_CASE("a stop ends a report with the parts that are made") {
    const auto ask = [](const std::vector<std::string>& words) -> Json {
      if (words.front() == "choose") throw sim::Stopped("stopped");
      return made_up_answer(words);
    };
    const Json report = answer({.scene = "@tree"}, ask);
    CHECK(report["parts"].size() == 2);
    CHECK(report["stopped"] == true);
    for (const FieldText& field : describe_report()) CHECK_FALSE(field.meaning.empty());
  }
}

}  // namespace detp::validate
