#include "detp/validate/accuracy/accuracy_answer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"

namespace detp::validate {
namespace {

AccuracyRequest request_of(const char* scene) {
  return {.scene = {.name = scene, .samples = {}},
          .target = {AccuracyTarget::Kind::noise, 0.2},
          .estimators = {sim::Estimator::disc, sim::Estimator::gather},
          .effort = PlanningEffort::quick,
          .command = "detp run @furnace",
          .command_end = " --front-facing"};
}

}  // namespace

TEST_SUITE("answers of accuracy") {
  TEST_CASE("one call answers; its JSON and its rows have what the lists of fields say") {
    AccuracyRequest request = request_of("@furnace");
    request.seeds = RerunSeeds{3, 4};
    request.check = true;
    std::vector<std::string> notes;
    const AccuracyAnswer found = answer(request, {}, {}, [&](const std::string& note) { notes.push_back(note); });
    CHECK(found.plan.reached);
    CHECK_FALSE(found.stopped);
    CHECK(found.reruns.size() == 2);
    CHECK(notes.size() == found.warnings.size());
    const Json json = to_json(found);
    CHECK(json["answer"]["reached"] == true);
    CHECK(json["answer"]["measured_noise"] == found.check->noise);
    CHECK(json["answer"]["command"].get<std::string>().starts_with("detp run @furnace --"));
    CHECK(json["answer"]["command"].get<std::string>().ends_with(" --front-facing"));
    CHECK(json["reruns"]["runs"][1]["seed"] == 4);
    CHECK(inputs_json(found)["target_noise"] == 0.2);
    const Columns columns = accuracy_columns();
    const std::vector<Json> rows = accuracy_rows(found);
    CHECK(rows.size() == 3 + found.plan.rivals.size() + found.plan.points.size());
    for (const Json& row : rows)
      for (const auto& [key, value] : row.items()) CHECK(std::ranges::find(columns, key) != columns.end());
  }

  TEST_CASE("each field has a meaning, and no list has a name twice") {
    std::set<std::string> names;
    for (const FieldText& field : describe_accuracy()) {
      CHECK_FALSE(field.meaning.empty());
      if (!field.name.empty()) CHECK_MESSAGE(names.insert(field.name).second, field.name);
    }
    CHECK(names.contains("answer"));
    CHECK(names.contains("points.noise"));
    CHECK(names.contains("reference.kind"));
  }

  TEST_CASE("pilots grow as they are asked to, until nothing is asked") {
    sim::Scene furnace = sim::open_scene({.name = "@furnace", .samples = {}});
    PilotMaker maker(furnace, {.estimators = {sim::Estimator::disc}});
    AccuracyPilot pilot;
    std::vector<double> rays;
    escalate(maker, pilot, {2000, 16}, [&](const PilotSize& made) -> std::optional<PilotSize> {
      CHECK(pilot.rays >= made.rays);
      CHECK(pilot.judge.paths == made.paths);
      rays.push_back(made.rays);
      if (rays.size() == 3) return std::nullopt;
      return PilotSize{2 * made.rays, 2 * made.paths};
    });
    CHECK(rays == std::vector<double>{2000, 4000, 8000});
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("scenes without triangles, single seeds, and a stop request before there is an answer") {
    CHECK_THROWS_WITH_AS((void)answer(request_of("@uniform")), doctest::Contains("no triangles"),
                         std::invalid_argument);
    AccuracyRequest request = request_of("@furnace");
    request.seeds = RerunSeeds{5, 5};
    CHECK_THROWS_WITH_AS((void)answer(request), doctest::Contains("number of seeds"), std::invalid_argument);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS((void)answer(request_of("@furnace"), source.get_token()), sim::Stopped);
  }
}

}  // namespace detp::validate
