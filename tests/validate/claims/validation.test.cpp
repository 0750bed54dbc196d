#include "detp/validate/claims/validation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace detp::validate {
namespace {

ValidateRequest small_request(std::vector<std::string> experiments) {
  ValidateRequest request{.job = {}, .experiments = std::move(experiments)};
  request.job.rays = 2000;
  request.job.samples = 300;
  request.job.disc_radius = Length{0.1};
  request.job.seed = 3;
  return request;
}

}  // namespace

TEST_SUITE("claims") {
  TEST_CASE("a request in numbers is answered with verdicts, and every cell of its rows has a column") {
    ValidateRequest request = small_request({"lines"});
    request.form = Form::corrected;
    const ValidateAnswer found = answer(request);
    CHECK(found.findings.size() == 5);
    CHECK(found.claims.size() == 9);
    CHECK(found.shown.size() == 5);
    CHECK_FALSE(found.stopped);
    CHECK(found.inputs["samples_are"] == "uniform");
    const Columns columns = validate_columns();
    const std::vector<Json> rows = validate_rows(found);
    REQUIRE(rows.size() == 5);
    for (const auto& [name, value] : rows.front().items()) {
      CAPTURE(name);
      CHECK(std::ranges::find(columns, name) != columns.end());
    }
    CHECK(std::set<std::string>(columns.begin(), columns.end()).size() == columns.size());
    const Json json = json_of(found);
    CHECK(json["claims"][0]["control"]["verdict"] == rows.front()["control_verdict"]);
    CHECK_FALSE(json["claims"][0].contains("reached"));
    for (const FieldText& field : describe_validate()) CHECK_FALSE(field.meaning.empty());
  }

  TEST_CASE("counted until the error is small, claims say how far they got") {
    ValidateRequest request = small_request({"lines"});
    request.until = {.relative_error = 0.5};
    const ValidateAnswer found = answer(request);
    CHECK_FALSE(found.not_reached);
    for (const Claim& claim : found.claims) CHECK(claim.refinement.value().reached);
    CHECK(json_of(found)["claims"][0]["reached"] == true);
    CHECK(found.inputs["until_relative_error"] == 0.5);
  }

  TEST_CASE("a published form is documented where the corrected form predicts another number") {
    const Finding wrong{.id = "count",
                        .quantity = "count",
                        .predictions = {{Form::published, "eq", 11}, {Form::corrected, "ours", 10}},
                        .observed = {10, 0}};
    Finding same = wrong;
    same.predictions[1].value = 11;
    CHECK(judge_all({wrong})[0].documented);
    CHECK_FALSE(judge_all({wrong})[1].documented);
    CHECK_FALSE(judge_all({same})[0].documented);
  }

  TEST_CASE("requests that contradict themselves are refused") {
    ValidateRequest both = small_request({});
    both.sweep_samples = 1e3;
    both.until = FindingsTarget{};
    CHECK_THROWS_AS(static_cast<void>(answer(both)), std::invalid_argument);
    ValidateRequest alone = small_request({});
    alone.checkpoint = "file.json";
    CHECK_THROWS_AS(static_cast<void>(answer(alone)), std::invalid_argument);
  }
}

}  // namespace detp::validate
