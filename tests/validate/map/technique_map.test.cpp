#include "detp/validate/map/technique_map.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "detp/model/rank/choose.hpp"
#include "detp/sim/files/file_error.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/scratch_file.hpp"
#include "support/sealed.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

JobRequest scene_request(double samples = 500) {
  JobRequest request;
  request.scene = "@uniform";
  request.samples = samples;
  return request;
}

JobRequest number_request() {
  JobRequest request;
  request.samples = 1e4;
  request.disc_radius = Length{0.01};
  request.scene_side = 2;
  return request;
}

constexpr UnitCosts free_of_cost{.cull_test = 0, .disc_test = 0, .index_test = 0, .step = 0, .node = 0};

MapRequest map_request(const JobRequest& job, const MapAxes& axes) {
  return {.job = job, .axes = axes, .costs = built_in_unit_costs()};
}

}  // namespace

TEST_SUITE("identity") {
  TEST_CASE("each cell has the candidate that a pilot of the cell's own job chooses") {
    const MapAxes axes{{300, 3000}, {{0.02, true}, {0.08, true}}};
    const TechniqueMap map = answer(map_request(scene_request(), axes));
    CHECK_FALSE(map.stopped);
    CHECK(map.rays == axes.rays);
    REQUIRE(map.rows.size() == 2);
    for (std::size_t j = 0; j < 2; ++j) {
      REQUIRE(map.rows[j].cells.size() == 2);
      for (const MapCell& cell : map.rows[j].cells) {
        JobRequest own = scene_request();
        own.rays = cell.rays;
        own.disc_radius = axes.radii[j];
        const Job job = make_job(own);
        CHECK(job.workload().disc_radius == map.rows[j].workload.disc_radius);
        const sim::Problem& problem = job.problem();
        const Choice pilot = choose({.problem = &problem}, built_in_unit_costs());
        REQUIRE(cell.choice);
        CHECK(cell.choice->rigor == Rigor::pilot);
        CHECK(cell.choice->best().candidate == pilot.best().candidate);
        CHECK(cell.choice->best().time.total() == pilot.best().time.total());
        CHECK(cell.choice->best().error == pilot.best().error);
        CHECK(cell.paper == model::paper_rule(job.workload()));
        CHECK_FALSE(cell.analysis);
      }
    }
  }

  TEST_CASE("a map of numbers has the first of each ranking, without rays") {
    const TechniqueMap map = answer(map_request(number_request(), {{1e4, 1e12}, {{0.01}}}));
    CHECK(map.name == "uniform samples in a cube");
    for (const MapCell& cell : map.rows.at(0).cells) {
      const Workload workload = cube_workload(cell.rays, 1e4, 0.01, 2);
      REQUIRE(cell.choice);
      CHECK(cell.choice->rigor == Rigor::estimate);
      CHECK(cell.choice->best().candidate == model::rank(workload, built_in_unit_costs()).front().candidate);
    }
  }

  TEST_CASE("axes without values have the default ones") {
    const TechniqueMap map = answer(map_request(number_request(), {}));
    CHECK(map.rays == default_map_rays());
    CHECK(map.rows.size() == default_map_radii().size());
  }

  TEST_CASE("rows ascend by radius, and equal radii are one row") {
    const TechniqueMap map = answer(map_request(number_request(), {{10}, {{0.08, true}, {0.1}, {0.05, true}, {0.02}}}));
    REQUIRE(map.rows.size() == 3);
    CHECK(map.rows[0].workload.disc_radius == 0.02);
    CHECK(map.rows[1].workload.disc_radius == doctest::Approx(0.1));
    CHECK(map.rows[2].workload.disc_radius == doctest::Approx(0.16));
    CHECK(map.rows[0].x > map.rows[1].x);
  }

  TEST_CASE("a measured map has the analysis of each cell, without disabled techniques") {
    MapRequest request = map_request(scene_request(100), {{20, 40}, {{0.05, true}}});
    request.measure = true;
    request.repeats = 1;
    request.disabled = {Technique::bvh};
    const TechniqueMap map = answer(request);
    CHECK_FALSE(map.stopped);
    for (const MapCell& cell : map.rows.at(0).cells) {
      REQUIRE(cell.analysis);
      CHECK(cell.analysis->candidates.front().candidate == cell.choice->best().candidate);
      CHECK(cell.analysis->regret);
      for (const Analysed& one : cell.analysis->candidates) CHECK(one.candidate.technique != Technique::bvh);
    }
  }

  TEST_CASE("a resumed map takes measured cells from its checkpoint, and measures the others") {
    const support::ScratchFolder folder;
    MapRequest request = map_request(scene_request(100), {{20, 40}, {{0.05, true}}});
    request.measure = true;
    request.repeats = 1;
    request.checkpoint = folder.path("map.json");
    const TechniqueMap map = answer(request);
    auto file = nlohmann::json::parse(support::content_of(folder.path("map.json")));
    REQUIRE(file.at("state").size() == 2);
    file["state"].erase(file["state"].begin());
    for (nlohmann::json& one : file["state"].begin().value()["candidates"])
      if (one["seconds"].is_number()) one["seconds"] = 100 + one["seconds"].get<double>();
    folder.file("map.json", support::sealed_checkpoint(file));
    request.resume = true;
    const TechniqueMap again = answer(request);
    const auto measured = [&](const TechniqueMap& one, std::size_t cell) {
      return *one.rows.at(0).cells.at(cell).analysis;
    };
    int kept = 0;
    for (std::size_t cell = 0; cell < 2; ++cell) {
      const Analysis before = measured(map, cell);
      const Analysis after = measured(again, cell);
      kept += after.candidates.front().seconds == 100 + *before.candidates.front().seconds ? 1 : 0;
      for (const Analysed& one : after.candidates) CHECK((!one.seconds || *one.seconds > 0));
      CHECK(after.candidates.front().candidate == before.candidates.front().candidate);
      CHECK(after.candidates.front().predicted);
      CHECK(after.candidates.front().counted == before.candidates.front().counted);
    }
    CHECK(kept == 1);
    CHECK(nlohmann::json::parse(support::content_of(folder.path("map.json"))).at("state").size() == 2);
    request.threads = 2;
    CHECK_THROWS_AS((void)answer(request), sim::FileError);
  }

  TEST_CASE("a stop request ends a map: rows so far, no half cells") {
    std::stop_source stop;
    MapRequest request = map_request(scene_request(), {{20, 40}, {{0.05, true}}});
    request.measure = true;
    bool measuring = false;
    const sim::ReportPhase progress = [&](const sim::Phase& phase) {
      if (phase.from >= 0.1) {
        measuring = true;
        stop.request_stop();
      }
    };
    const TechniqueMap map = answer(request, stop.get_token(), progress);
    CHECK(measuring);
    REQUIRE(map.stopped);
    CHECK(map.stopped->done == 0);
    CHECK(map.stopped->of == 2);
    REQUIRE(map.rows.size() == 1);
    for (const MapCell& cell : map.rows[0].cells) {
      CHECK(cell.choice);
      CHECK_FALSE(cell.analysis);
    }
    const TechniqueMap none = answer(request, stop.get_token(), progress);
    CHECK(none.rows.empty());
    REQUIRE(none.stopped);
    CHECK(none.stopped->of == 2);
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a rigor that a map cannot have, costs of 0 and rays that do not fit in memory are refused") {
    MapRequest request = map_request(scene_request(), {{10}, {}});
    request.rigor = Rigor::structural;
    CHECK_THROWS_WITH_AS((void)answer(request), doctest::Contains("structures"), std::invalid_argument);
    request.job = number_request();
    request.rigor = Rigor::pilot;
    CHECK_THROWS_WITH_AS((void)answer(request), doctest::Contains("needs rays"), std::invalid_argument);
    request.rigor.reset();
    request.costs = free_of_cost;
    CHECK_THROWS_AS((void)answer(request), std::invalid_argument);
    request = map_request(scene_request(), {{1e15}, {{0.01, true}}});
    request.measure = true;
    CHECK_THROWS_WITH_AS((void)answer(request), doctest::Contains("1 disc radii"), std::length_error);
  }
}
