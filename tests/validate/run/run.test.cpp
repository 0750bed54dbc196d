#include "detp/validate/run/run_fields.hpp"

#include <doctest/doctest.h>

#include <set>

#include "support/command.hpp"

namespace detp::validate {
namespace {

RunRequest in_cornell(double rays) {
  RunRequest request;
  request.job.scene = "@cornell";
  request.job.rays = rays;
  request.job.threads = 1;
  return request;
}

}  // namespace

TEST_SUITE("one call") {
  TEST_CASE("a request to the library gets the answer of the command") {
    RunRequest request = in_cornell(5000);
    request.technique = Technique::grid;
    request.parameters.values = {{"cells", std::int64_t{6}}};
    const JobAndRun found = answer(request);
    const Json of_library = json_of(run_fields(), shown_run(found.job, found.answer));
    const Json of_command =
        support::result_of("run @cornell --rays 5000 --threads 1 --technique grid --cells 6 --calibration none");
    for (const char* key :
         {"technique", "parameters", "hits", "mean_irradiance", "counts", "predicted", "photons", "light"})
      CHECK(nlohmann::json(of_library[key]) == nlohmann::json(of_command[key]));
  }

  TEST_CASE("a run until an error, in one call") {
    RunRequest request = in_cornell(1e6);
    request.target = RunTarget{.error = {.error = 0.3}};
    const RunAnswer found = answer(request).answer;
    REQUIRE(found.until);
    CHECK(found.until->result.reason == StopReason::target);
    CHECK(found.until->result.noise.high < 0.3);
  }

  TEST_CASE("parameters without a technique choose one that has them") {
    RunRequest request = in_cornell(5000);
    request.parameters.values = {{"leaf", std::int64_t{8}}};
    const Candidate leaf = answer(request).answer.candidate;
    CHECK(find_parameter(leaf.technique, "leaf")->get(leaf.parameters) == ParameterValue(std::int64_t{8}));
    request.parameters.values = {{"ratio", 0.65}};
    const Candidate ratio = answer(request).answer.candidate;
    CHECK(find_parameter(ratio.technique, "ratio")->get(ratio.parameters) == ParameterValue(0.65));
    request.parameters.values = {{"nearest", std::int64_t{8}}};
    CHECK_THROWS_AS(static_cast<void>(answer(request)), std::invalid_argument);
  }

  TEST_CASE("bad requests are refused before anything is made") {
    RunRequest request = in_cornell(5000);
    request.technique = Technique::photon_map;
    CHECK_THROWS_AS(check(request), std::invalid_argument);
    request = in_cornell(5000);
    request.technique = Technique::grid;
    request.parameters.values = {{"leaf", std::int64_t{8}}};
    CHECK_THROWS_AS(check(request), std::invalid_argument);
    request.parameters.values.clear();
    request.form = Form::published;
    CHECK_THROWS_AS(check(request), std::invalid_argument);
    request = in_cornell(5000);
    request.target = RunTarget{};
    request.pairs = true;
    CHECK_THROWS_AS(check(request), std::invalid_argument);
  }

  TEST_CASE("each field has one name, a meaning, and columns of its own") {
    std::set<std::string> names;
    for (const FieldText& field : describe_fields(run_fields())) {
      CAPTURE(field.name);
      CHECK(!field.meaning.empty());
      CHECK(names.insert(field.name).second);
    }
    const Columns columns = columns_of(run_fields());
    CHECK(united({}, columns).size() + 1 == columns.size());  // hits are among the counts, too
  }
}

}  // namespace detp::validate
