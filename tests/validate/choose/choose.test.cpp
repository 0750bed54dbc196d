#include "detp/validate/choose/choose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>

#include "detp/sim/base/stopped.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/command.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

ChooseRequest request_in_cornell() {
  ChooseRequest request;
  request.costs = built_in_unit_costs();
  request.job.scene = "@cornell";
  request.job.rays = 3000;
  request.job.seed = 3;
  return request;
}

}  // namespace

TEST_SUITE("end to end") {
  TEST_CASE("one call gives what the command says") {
    const Json json = json_of(choose_fields(), answer(request_in_cornell()));
    const Json said = support::result_of("choose @cornell --rays 3000 --seed 3 --threads 1 --calibration none");
    for (const char* key : {"choice", "candidates", "paper_rule", "ruled_out", "not_examined", "rigor"}) {
      CAPTURE(key);
      CHECK(nlohmann::json(json.at(key)) == nlohmann::json(said.at(key)));
    }
    for (const auto& one : json.items()) CHECK_MESSAGE(said.contains(one.key()), one.key());
  }
}

TEST_SUITE("identity") {
  TEST_CASE("every field of an answer has a meaning, and no two columns have one name") {
    Columns columns;
    for (const FieldText& field : describe_choose()) {
      CHECK_FALSE(field.meaning.empty());
      columns = columns + field.columns;
    }
    std::sort(columns.begin(), columns.end());
    CHECK(std::adjacent_find(columns.begin(), columns.end()) == columns.end());
  }

  TEST_CASE("with an analysis, all candidates that have a prediction by the rigor of the choice get it" *
            doctest::test_suite("long")) {
    ChooseRequest request = request_in_cornell();
    request.analyze = true;
    request.disabled = {Technique::octree};
    bool made = false;
    request.made = [&](const Job& job) { made = !job.discs.empty(); };
    const ChooseAnswer found = answer(request);
    CHECK(made);
    REQUIRE(found.analysis);
    REQUIRE(found.fastest() != nullptr);
    for (const ChooseRow& row : rows_of(found)) {
      CAPTURE(title(row.candidate));
      CHECK(row.candidate.technique != Technique::octree);
      CHECK((row.predicted != nullptr) == model::has_closed_form(row.candidate.technique));
      CHECK(row.chosen() == row.why_not.empty());
      CHECK((row.run->seconds.has_value()) == row.not_run.empty());
    }
    CHECK(explained_rows(found).front().candidate == found.choice.best().candidate);
  }

  TEST_CASE("numbers alone are chosen for without rays") {
    ChooseRequest request;
    request.costs = built_in_unit_costs();
    request.job.samples = 1e4;
    request.job.disc_radius = Length{0.02};
    request.job.scene_side = 2;
    request.ranks = {.ranks = 4};
    const ChooseAnswer found = answer(request);
    CHECK_FALSE(found.job);
    CHECK(found.rigor == Rigor::estimate);
    REQUIRE(found.ranks);
    CHECK(found.ranks->ranks == 4);
    CHECK(paper_row(found).role == "paper rule");
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("costs with which nothing can be compared are refused; a stop request ends a pilot") {
    ChooseRequest request = request_in_cornell();
    request.costs = UnitCosts{.cull_test = 0, .disc_test = 0, .index_test = 0, .step = 0, .node = 0};
    CHECK_THROWS_WITH_AS((void)answer(request), doctest::Contains("takes no time"), std::invalid_argument);
    std::stop_source stop;
    request = request_in_cornell();
    request.made = [&](const Job&) { stop.request_stop(); };
    CHECK_THROWS_AS((void)answer(request, stop.get_token()), sim::Stopped);
  }
}
