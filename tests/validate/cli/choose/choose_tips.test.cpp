#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/command.hpp"

namespace detp::support {

TEST_SUITE("end to end") {
  TEST_CASE("tips say with which inputs the choice is another one") {
    const std::string scene = "choose @uniform --samples 2000 --disc-radius 2% --calibration none --threads 1 --rays ";
    const auto fewer_rays = [](const Json& json) {
      for (const Json& tip : json.at("tips"))
        if (tip.at("input") == "rays" && tip.at("change") == "technique" && tip.at("ratio") < 1) return tip;
      return Json();
    };
    for (const auto& row : {std::pair(60, ""), {60, " --rigor structural"}, {100, " --rigor estimate"}}) {
      const int rays = row.first;
      const std::string rigor = row.second;  // not a structured binding, which CAPTURE cannot take
      CAPTURE(rigor);
      const std::string line = scene + std::to_string(rays) + rigor;
      const Json json = result_of(line);
      REQUIRE(json.at("choice").at("technique") == "box-tree");
      const Json tip = fewer_rays(json);
      REQUIRE(tip.is_object());
      CHECK(tip.at("technique") == "brute-force");
      CHECK(tip.at("threads") == 1);
      CHECK(tip.at("parameters").is_object());
      CHECK(tip.at("at").get<double>() == doctest::Approx(rays * tip.at("ratio").get<double>()));
      CHECK(json.at("tips_seconds") > 0);
      for (const char* const detail : {"", " --verbose"}) {
        const std::string text = std::regex_replace(detp(line + detail).out, std::regex("\n {10}"), " ");
        CHECK(text.find("\ntips      ") != std::string::npos);
        CHECK(text.find("brute-force is faster with ") != std::string::npos);
        CHECK(text.find(fmt::format("{:.0f} rays or fewer", tip.at("at").get<double>())) != std::string::npos);
      }
      const auto fewer = static_cast<int>(0.9 * tip.at("at").get<double>());
      const Json there = result_of(fmt::format("{}{}{}", scene, fewer, rigor));
      CHECK(there.at("choice").at("technique") == "brute-force");
    }
    const Json without = result_of(scene + "150 --disable brute-force");
    CHECK_FALSE(fewer_rays(without).is_object());
    CHECK(without.at("tips_range").at("rays")[0] == 38);
    CHECK(detp(scene + "150 --disable brute-force").out.find("wins for d from 0.01 to 0.16, for 38 to 600 rays") !=
          std::string::npos);
  }
}

}  // namespace detp::support
