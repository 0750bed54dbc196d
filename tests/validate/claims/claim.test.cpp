#include "detp/validate/claims/claim.hpp"

#include <doctest/doctest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "detp/validate/claims/experiments.hpp"
#include "detp/validate/claims/validation.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

Finding finding(double predicted, Estimate observed, double tolerance, int batches) {
  return {.id = "tests",
          .quantity = "tests",
          .predictions = {{Form::corrected, "none", predicted}},
          .observed = observed,
          .batches = batches,
          .tolerance = tolerance};
}

Claim judged(const Finding& one) { return judge_all({one}).front(); }

Experiment small_experiment() {
  return {.workload = cube_workload(3200, 300, 0.03, 2), .discs = {}, .seed = 5, .stop = {}};
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a control is refuted as near to the tolerance as the noise allows; at half that distance it is not") {
    for (const double observed : {99.9, 100.1})
      for (const double tolerance : {0.02, 0.25})
        for (const double error : {0.01, 0.3, 2.0}) {
          INFO("observed ", observed, ", tolerance ", tolerance, ", error ", error);
          const Claim claim = judged(finding(100, {observed, error}, tolerance, 32));
          CHECK(claim.control_verdict == Verdict::refuted);
          CHECK(claim.control == doctest::Approx(100 * (1 + claim.control_offset)));
          CHECK((claim.control_offset > 0) == (observed < 100));
          const double nearest = tolerance / (1 - std::copysign(tolerance, claim.control_offset));
          const double nearer =
              100 * (1 + std::copysign(0.5 * (nearest + std::abs(claim.control_offset)), claim.control_offset));
          CHECK(judged(finding(nearer, {100, error}, tolerance, 32)).verdict == Verdict::undecided);
        }
  }

  TEST_CASE("the control of an exact count is one count more, or less, than the tolerance allows") {
    const Claim exact = judged(finding(10, {10, 0}, 0, 0));
    CHECK(exact.verdict == Verdict::agrees);
    CHECK(exact.control == doctest::Approx(11));
    CHECK(exact.control_verdict == Verdict::refuted);
    const Claim within = judged(finding(100, {104, 0}, 0.05, 0));
    CHECK(within.verdict == Verdict::agrees);
    CHECK(within.control == doctest::Approx(100 * (1 - 0.06 / 1.05)));
    CHECK(within.control_verdict == Verdict::refuted);
  }

  TEST_CASE("with unknown noise neither the claim nor the control is decided") {
    const Claim claim = judged(finding(100, {100, INFINITY}, 0.25, 2));
    CHECK(claim.verdict == Verdict::undecided);
    CHECK(claim.control_verdict == Verdict::undecided);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("the findings do not depend on the number of threads" * doctest::test_suite("long")) {
    const auto findings_on = [](std::size_t threads) {
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      std::vector<Finding> findings = sphere_cache_findings(small_experiment());
      for (Finding& finding : disc_index_findings(small_experiment())) findings.push_back(finding);
      return findings;
    };
    const auto one = findings_on(1);
    const auto two = findings_on(2);
    REQUIRE(one.size() == two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      CHECK(one[i].observed.mean == two[i].observed.mean);
      CHECK(one[i].observed.standard_error == two[i].observed.standard_error);
    }
  }

  TEST_CASE("after a stop request there are no incomplete findings") {
    std::stop_source source;
    source.request_stop();
    Experiment experiment = small_experiment();
    experiment.stop = source.get_token();
    CHECK(all_findings(experiment).empty());
  }
}

TEST_SUITE("statistical") {
  void check_claims(double dimension, double samples) {
    CAPTURE(dimension);
    Experiment experiment{
        .workload = cube_workload(480'000, samples, 0.02, 2, dimension), .discs = {}, .seed = 20261121, .stop = {}};
    const std::vector<Claim> claims = judge_all(all_findings(experiment));
    std::set<std::string> ids;
    for (const Claim& claim : claims) {
      INFO("claim.id ", claim.id, ", claim.relative_difference ", claim.relative_difference);
      ids.insert(claim.id);
      CAPTURE(claim.control_offset);
      if (claim.form == Form::corrected) CHECK(claim.verdict == Verdict::agrees);
      CHECK(claim.control_verdict == Verdict::refuted);
    }
    for (const char* wrong : {"sphere-count", "rebuilds", "rebuild-time", "intersect-time", "octree-tests-per-line"})
      CHECK(std::any_of(claims.begin(), claims.end(), [&](const Claim& claim) {
        return claim.id == std::string(wrong) + ".published" && claim.verdict == Verdict::refuted;
      }));
    for (const char* id : {"sphere-hit-probability.corrected", "disc-hit-probability.corrected",
                           "rays-in-sphere-1.corrected", "cells-per-line.corrected", "hits-per-line.corrected"})
      CHECK(ids.contains(id));
    for (const std::string engine : {"plain", "simd"})
      for (const char* count :
           {"box-tests", "disc-tests", "listed-rays", "nodes-visited", "discs-visited", "box-structural",
            "disc-structural", "listed-structural", "nodes-structural", "visits-structural"})
        CHECK(ids.contains("box-tree-" + engine + "-" + count + ".corrected"));
    CHECK(std::count_if(claims.begin(), claims.end(), [](const Claim& c) { return c.verdict == Verdict::agrees; }) >=
          15);
  }

  TEST_CASE("every claim is judged: corrected ones agree, wrong ones are refuted, and so is each control") {
    check_claims(3, 20'000);
  }

  TEST_CASE("… also with the samples on the faces of a cube") {
    check_claims(2, 40'000);  // sets of 20 000 samples differ too much to decide all claims
  }
}

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
    for (const auto& [column, value] : rows.front().items()) {
      const std::string& name = column;
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
