#include <doctest/doctest.h>
#include <fmt/format.h>

#include <set>

#include "detp/model/vocabulary/technique.hpp"
#include "support/command.hpp"

namespace detp::support {
namespace {

void check_ranked(const Json& json) {
  const Json& candidates = json.at("candidates");
  CHECK_FALSE(json.contains("best_measured"));
  REQUIRE(candidates.size() >= 2);
  double last = 0;
  for (const Json& candidate : candidates) {
    CHECK(candidate.at("predicted_seconds").get<double>() >= last);
    last = candidate.at("predicted_seconds");
    CHECK(candidate.contains("why_not") == (&candidate != &candidates.front()));
    CHECK(candidate.at("technique") != "sphere-cache-published");
  }
  CHECK(last > 0);
  CHECK(json.at("choice").at("technique") == candidates[0].at("technique"));
  CHECK(json.at("choice").at("parameters") == candidates[0].at("parameters"));
  CHECK(json.at("choice").at("predicted_seconds") == candidates[0].at("predicted_seconds"));
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("a workload without a scene is ranked by predicted time" * doctest::test_suite("long")) {
    for (const std::string workload :
         {"--rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2", "--rays 1 --samples 1 --disc-radius 1e-3",
          "--rays 1e18 --samples 1e18 --disc-radius 1e-9", "--rays 1e6 --samples 10 --disc-radius 50%",
          "--rays 1e6 --samples 1e6 --disc-radius 1% --dimension 2", "--samples 100 --disc-radius 10"}) {
      const std::string line =
          "choose " + workload + (workload.find("side") == std::string::npos ? " --scene-side 1" : "");
      CAPTURE(line);
      const Finished finished = detp(line + " --format json");
      CHECK(finished.code == 0);
      check_ranked(finished.json());
      for (const std::string format : {"text", "csv", "json"})
        CHECK_FALSE(has_no_number(detp(line + " --format " + format).out));
    }
  }

  TEST_CASE("choose, model and run use the same box tree, with smaller leaves for more rays per disc") {
    int last = 1000;
    for (const char* const rays : {"100", "3000", "150000"}) {
      const std::string workload = std::string("@uniform --samples 2000 --disc-radius 2% --rays ") + rays;
      const Json parameters = result_of("run " + workload + " --technique box-tree").at("parameters");
      CHECK(parameters.at("leaf").get<int>() < last);
      last = parameters.at("leaf");
      const std::string tree = " --technique box-tree --fan-out " + parameters.at("fan_out").dump() + " --leaf ";
      const Json model = result_of("model " + workload + tree + parameters.at("leaf").dump());
      const Json chosen = result_of("choose " + workload + " --rigor estimate");
      for (const Json& candidate : chosen.at("candidates")) {
        if (candidate.at("technique") != "box-tree") continue;
        CHECK(candidate.at("parameters") == parameters);
        CHECK(candidate.at("predicted") == model.at("counts"));
      }
    }
  }

  TEST_CASE("with --front-facing, choose, model and run predict half of the hits, and as many tests" *
            doctest::test_suite("long")) {
    const std::string numbers = "--rays 2000 --samples 1000 --disc-radius 0.05 --scene-side 2";
    const std::string scene = "@uniform --rays 2000 --samples 1000 --disc-radius 2%";
    const auto check_half = [](const Json& both, const Json& fronts) {
      CHECK(fronts.at("hits").get<double>() == both.at("hits").get<double>() / 2);
      CHECK(fronts.at("disc_tests") == both.at("disc_tests"));
    };
    for (const std::string& workload : {numbers, scene}) {
      CAPTURE(workload);
      const std::string choose = "choose --rigor estimate " + workload;
      const Json fronts = result_of(choose + " --front-facing");
      CHECK(fronts.at("inputs").at("front_facing") == true);
      check_half(result_of(choose).at("candidates")[0].at("predicted"), fronts.at("candidates")[0].at("predicted"));
      const std::string grid = workload + " --technique grid --cells 8";
      check_half(result_of("model " + grid).at("counts"), result_of("model " + grid + " --front-facing").at("counts"));
      check_half(result_of("run " + grid).at("predicted"),
                 result_of("run " + grid + " --front-facing").at("predicted"));
    }
    const std::string structural = "choose " + scene + " --rigor structural";
    check_half(result_of(structural).at("candidates")[0].at("predicted"),
               result_of(structural + " --front-facing").at("candidates")[0].at("predicted"));
  }

  TEST_CASE("choose and model mark extrapolated predictions, with the reason") {
    const std::string few = "--samples 50 --rays 1000 --disc-radius 0.01 --scene-side 2";
    const Json reasons{"samples 50 below 1000"};
    const Json choice = result_of("choose " + few);
    for (const Json& candidate : choice.at("candidates")) {
      const bool exact = candidate.at("technique") == "brute-force";
      CHECK(candidate.at("extrapolated") == !exact);
      CHECK(candidate.at("extrapolated_because").empty() == exact);
    }
    const Json outside = result_of("model " + few + " --ratio 0.65");
    CHECK(outside.at("extrapolated") == true);
    CHECK(outside.at("extrapolated_because") == reasons);
    CHECK(detp("choose " + few + " --verbose")
              .out.find("~ extrapolated: samples 50 below 1024 (box-tree); samples 50 below 1000 (") !=
          std::string::npos);
    CHECK(detp("choose " + few).out.find("; extrapolated: samples 50 below 1024\n") != std::string::npos);
    CHECK(detp("model " + few + " --ratio 0.65").out.find("samples 50 below 1000") != std::string::npos);
    const std::string many = "--samples 1e5 --rays 1000 --disc-radius 0.01 --scene-side 2";
    CHECK(result_of("model " + many + " --ratio 0.65").at("extrapolated") == false);
    CHECK(result_of("choose " + many).at("choice").at("extrapolated") == false);
  }

  TEST_CASE("unit costs from the command line decide: if only stepping is expensive, all rays are tested") {
    const Json json = result_of(
        "choose --rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2 --costs "
        "t=1,u=1e-12,v=1,n=1,c=1,b=1,s=1,r=1");
    check_ranked(json);
    CHECK(json.at("choice").at("technique") == "brute-force");
    CHECK(json.at("choice").at("predicted_seconds").get<double>() == doctest::Approx(0.01));
  }

  TEST_CASE("a disabled technique is neither ranked nor run" * doctest::test_suite("long")) {
    const auto technique_of = [](const std::string& arguments) {
      return result_of("choose " + arguments).at("choice").at("technique").get<std::string>();
    };
    const std::string scene = "@uniform --samples 2000 --rays 2000 --disc-radius 2%";
    CHECK(technique_of(scene) == "box-tree");
    CHECK(technique_of(scene + " --disable box-tree") != "box-tree");
    CHECK(technique_of(scene + " --disable box-tree,grid --rigor estimate") != "box-tree");
    const std::set<std::string> disabled{"grid", "octree", "ray-map", "bsp"};
    const Json analysed = result_of("choose " + scene + " --disable grid,octree,ray-map,bsp --analyze");
    for (const Json& candidate : analysed.at("candidates")) CHECK(disabled.count(candidate.at("technique")) == 0);
    check_refused(
        {{"choose " + scene + " --disable tree", "sphere-tree"},
         {"choose " + scene + " --disable box-tree --rigor pilot", "box-tree"},
         {"choose " + scene + " --disable brute-force,sphere-cache,cell-spheres,sphere-tree,box-tree,octree,grid",
          "leaves no technique"}});
  }

  TEST_CASE("--technique names the only techniques that are considered, with every rigor" *
            doctest::test_suite("long")) {
    const std::string scene = "@uniform --samples 2000 --rays 2000 --disc-radius 2%";
    const auto techniques_of = [&](const std::string& arguments) {
      std::set<std::string> techniques;
      const Json json = result_of("choose " + scene + arguments);
      for (const Json& candidate : json.at("candidates")) techniques.insert(candidate.at("technique"));
      return techniques;
    };
    using Names = std::set<std::string>;
    CHECK(techniques_of(" --technique grid,octree") == Names{"grid", "octree"});
    CHECK(techniques_of(" --technique box-tree") == Names{"box-tree"});
    CHECK(techniques_of(" --technique box-tree,brute-force --rigor structural") == Names{"box-tree", "brute-force"});
    CHECK(techniques_of(" --technique box-tree,grid --rigor pilot --disable grid") == Names{"box-tree"});
    CHECK(techniques_of(" --technique cell-spheres --rigor measure") == Names{"cell-spheres"});
    CHECK(techniques_of(" --technique bsp,grid --rigor measure") == Names{"bsp", "grid"});
    const Json grid = result_of("choose " + scene + " --technique grid");
    CHECK(grid.at("choice").at("parameters") == result_of("run " + scene + " --technique grid").at("parameters"));
    CHECK(grid.at("inputs").at("disabled").size() == detp::exact_techniques.size() - 1);
    CHECK(result_of("choose " + scene).at("inputs").at("disabled").empty());
    const Json map =
        result_of("choose @uniform --samples 2000 --map --rays 100,1000 --disc-radius 2% --technique octree");
    for (const Json& cell : map.at("cells")) CHECK(cell.at("predicted").at("technique") == "octree");
    check_refused({{"choose " + scene + " --technique gird", "did you mean grid?"},
                   {"choose " + scene + " --technique grid --disable grid", "--technique with --disable leaves no"},
                   {"choose " + scene + " --technique bsp", "--technique leaves no technique"},
                   {"choose " + scene + " --technique grid --rigor pilot", "box-tree may not be chosen"},
                   {"choose " + scene + " --technique photon-map", "photon-map is never chosen"}});
  }

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

TEST_SUITE("bad input") {
  TEST_CASE("unit costs that make all candidates equal are refused by choose") {
    const std::string choose = "choose --samples 10 --disc-radius 0.1 --scene-side 1 --costs ";
    check_refused({{choose + "u=0", "t, u, w, v, n, c, b, g, s, r, l, h, i, e, m, y, z, a cost 0"},
                   {choose + "t=1e-9,u=1e-9", "w, v, n, c, b, g, s, r, l, h, i, e, m, y, z, a cost 0"},
                   {choose + "w=1,v=1,n=1", "brute-force takes no time"},
                   {choose + "t=1e308,u=1e308,w=1e308,v=1,n=1", "(t) must be from 0 to 1e+200"}});
  }
}

}  // namespace detp::support
