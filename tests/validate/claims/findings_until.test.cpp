#include "detp/validate/claims/findings_until.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "detp/validate/checkpoint/checkpoint_file.hpp"
#include "support/scratch_file.hpp"

namespace detp::validate {
namespace {

Experiment small(double lines, std::uint64_t seed) {
  return {.workload = cube_workload(lines, 300, 0.1, 2, 3), .discs = {}, .seed = seed};
}

/// The quickest of all experiments.
std::span<const ExperimentStep> lines_alone() {
  return {
      std::ranges::find(experiment_steps(), std::string_view("lines against spheres and discs"), &ExperimentStep::name),
      1};
}

}  // namespace

TEST_SUITE("long") {
  TEST_CASE("each observed value is known as well as asked, or says what is missing") {
    const FindingsTarget target{.relative_error = 0.1, .most_lines = 1e6};
    const FindingsUntil until = findings_until(small(2000, 1), target);
    CHECK_FALSE(until.stopped);
    REQUIRE(until.findings.size() > 40);
    std::size_t reached = 0;
    for (const Finding& finding : until.findings) {
      const Refinement& one = finding.refinement.value();
      CAPTURE(finding.id);
      CHECK(one.reached == (one.relative_error <= target.relative_error));
      reached += one.reached ? 1 : 0;
      if (finding.batches == 0) CHECK(one.relative_error == 0);
      if (one.reached) continue;
      REQUIRE(one.more_lines);
      CHECK(*one.more_lines ==
            doctest::Approx((std::pow(one.relative_error / 0.1, 2) - 1) * static_cast<double>(finding.lines)));
      CHECK(*one.more_seconds > 0);
    }
    CHECK(reached > 40);
    // Lines as they are needed: an observed value that was known after the first repetition has no more.
    const auto lines = [&](const char* id) {
      return std::ranges::find(until.findings, std::string(id), &Finding::id)->lines;
    };
    CHECK(lines("sphere-hit-probability") < lines("rebuilds") * 100);
    CHECK(findings_until(small(2000, 1), target).findings.front().observed.mean ==
          until.findings.front().observed.mean);
  }

  TEST_CASE("limits of lines hold") {
    const FindingsUntil few =
        findings_until(small(2000, 2), {.relative_error = 1e-4, .most_lines = 20'000}, lines_alone());
    for (const Finding& finding : few.findings)
      if (finding.id == "sphere-hit-probability") CHECK(finding.lines <= 20'000);
    const FindingsUntil many = findings_until(
        small(2000, 2), {.relative_error = 0.9, .least_lines = 100'000, .most_lines = 200'000}, lines_alone());
    for (const Finding& finding : many.findings)
      if (finding.id == "sphere-hit-probability") CHECK(finding.lines >= 100'000);
    std::stop_source stop;
    stop.request_stop();
    Experiment stopped = small(2000, 3);
    stopped.stop = stop.get_token();
    CHECK(findings_until(stopped, {}).stopped);
  }
}

TEST_SUITE("statistical") {
  TEST_CASE("stated errors hold for all of the values that are known exactly, in 95 % of the runs") {
    constexpr int runs = 200;
    int wrong = 0;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
      const FindingsUntil until =
          findings_until(small(500, 7000 + seed), {.relative_error = 0.05, .most_lines = 1e6}, lines_alone());
      bool right = true;
      for (const Finding& finding : until.findings) {
        if (!finding.id.starts_with("sphere-hit") && !finding.id.starts_with("disc-hit") &&
            !finding.id.starts_with("rays-in"))
          continue;
        const double away = std::abs(finding.predictions.back().value / finding.observed.mean - 1);
        right = right && away <= finding.refinement->relative_error;
      }
      wrong += right ? 0 : 1;
    }
    CHECK(wrong <= 19);  // of a binomial 0.05, more happens in 0.1 %
  }
}

TEST_SUITE("claims") {
  TEST_CASE("where nothing was met, the error is not known") {
    const ExperimentStep dark{
        "dark",
        "dark",
        [](const Experiment&) {
          return std::vector<Finding>{{.id = "hits", .quantity = "hits", .batches = 8, .lines = 100}};
        },
        [](const Experiment&) { return 1.0; },
        1,
        true};
    const FindingsUntil until = findings_until(small(100, 1), {.most_lines = 400}, {&dark, 1});
    REQUIRE(until.findings.size() == 1);
    const Refinement one = until.findings[0].refinement.value();
    CHECK_FALSE(one.reached);
    CHECK(std::isinf(one.relative_error));
    CHECK(std::isinf(one.more_lines.value()));
    CHECK(until.findings[0].lines == 400);
    // The first test may err with (1 - 0.95) 2/3; a test that had decided would leave less.
    CHECK(one.share_bound.value() >= -std::log(0.05 * 2 / 3) / 400);
    CHECK(one.share_bound.value() <= -std::log(0.05 * 2 / 9) / 400);
  }

  TEST_CASE("the second test of a target may err less than the first") {
    // The first repetition promises more than the others keep, so the first test fails.
    const ExperimentStep uneven{
        "uneven",
        "uneven",
        [](const Experiment& one) {
          const double error = one.seed == 1 ? 0.05 : 0.08;
          return std::vector<Finding>{
              {.id = "hits", .quantity = "hits", .observed = {1, error}, .batches = 8, .lines = 100}};
        },
        [](const Experiment&) { return 1.0; },
        1,
        true};
    const FindingsUntil until = findings_until(small(100, 1), {.relative_error = 0.1}, {&uneven, 1});
    REQUIRE(until.findings.size() == 1);
    const Refinement one = until.findings[0].refinement.value();
    CHECK(one.reached);
    CHECK(one.relative_error == doctest::Approx(interval_width(0.05 * 2 / 9, 1, until.findings[0].batches) *
                                                until.findings[0].observed.standard_error));
  }

  TEST_CASE("a standard error that is not known survives a checkpoint") {
    const support::ScratchFolder folder;
    CheckpointFile file(folder.path("checkpoint.json"), "test", nlohmann::json::object());
    file.write(Estimate{2, std::numeric_limits<double>::infinity()});
    const auto read = file.read();
    REQUIRE(read);
    CHECK(read->get<Estimate>().mean == 2);
    CHECK(std::isinf(read->get<Estimate>().standard_error));
  }

  TEST_CASE("targets out of range are refused") {
    for (const double wrong : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
      CHECK_THROWS_AS(check(FindingsTarget{.relative_error = wrong}), std::invalid_argument);
      CHECK_THROWS_AS(check(FindingsTarget{.confidence = wrong}), std::invalid_argument);
    }
    CHECK_THROWS_AS(check(FindingsTarget{.least_lines = 100, .most_lines = 10}), std::invalid_argument);
    CHECK_THROWS_AS(check(FindingsTarget{.least_lines = -1}), std::invalid_argument);
  }
}

}  // namespace detp::validate
