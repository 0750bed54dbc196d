#include "detp/validate/claims/experiments.hpp"

#include <doctest/doctest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <set>
#include <string>

using namespace detp;
using namespace detp::validate;

namespace {

Experiment small_experiment() {
  return {.workload = cube_workload(3200, 300, 0.03, 2), .discs = {}, .seed = 5, .stop = {}};
}

}  // namespace

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
      CAPTURE(claim.id);
      CAPTURE(claim.relative_difference);
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
