#include "detp/validate/regret/regret.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "detp/validate/bench/workload.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/regret/regret_answer.hpp"
#include "support/attempts.hpp"
#include "support/sanitized.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

/// A tier that always chooses the same candidate.
Chooser always(const Candidate& candidate) {
  return {"always", [candidate](const sim::Problem&, const Job&, int threads) {
            return Chosen{{.candidate = candidate, .threads = threads}};
          }};
}

BenchWorkload tiny_workload(bool held_out) {
  return {.scene = "@uniform",
          .discs = "@uniform",
          .samples = 100,
          .disc_radius = {0.04, true},
          .rays = 50,
          .held_out = held_out};
}

/// Whether a tier takes longer than the best constant on all workloads, by more than the noise.
///
/// The mean of n logarithms of regrets has a standard error of s/√n, where s is the standard deviation of a single
/// one, and so has its difference from another mean. The factor allowed is exp(mean |logarithm of the noise|), about
/// exp(0.8 s). With 34 workloads that is more than four standard errors, so a tier that is as fast as the constant
/// fails about once in 10⁵ runs. On a disturbed machine s grows, and the allowance with it.
bool loses(const RegretSummary& summary, std::size_t tier) {
  return summary.tiers.at(tier).regret.all.geometric_mean >
         summary.baselines.at(0).regret.all.geometric_mean * summary.noise.geometric_mean;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a row has the choice of each tier and every option of every baseline, beside the best") {
    const std::vector workloads{tiny_workload(false), tiny_workload(true)};
    std::vector<Chooser> choosers = all_choosers(built_in_unit_costs());
    const Candidate constant{Technique::box_tree, BoxTreeParameters{4, 16}};
    choosers.push_back(always(constant));
    const RegretResult result =
        run_regret(workloads, choosers, {.costs = built_in_unit_costs(), .more_threads = 2, .search = {.repeats = 1}});
    CHECK(result.done == 2);
    CHECK_FALSE(result.stopped);
    REQUIRE(result.rows.size() == 3);  // the first workload with two threads, too
    CHECK(result.rows[1].threads == 2);
    CHECK(result.rows[2].workload.held_out);
    for (const RegretRow& row : result.rows) {
      CHECK(row.rays == 50);
      CHECK(row.samples == 100);
      CHECK(row.tried > 12);
      REQUIRE(row.choices.size() == choosers.size());
      CHECK(row.choices[0].tier == "pilot");
      CHECK(row.choices[0].choice.predicted_seconds() > 0);
      CHECK(row.choices[0].choice.choosing_seconds > 0);
      CHECK(row.choices.back().choice.prediction.candidate == constant);
      for (const ChoiceRow& choice : row.choices) {
        if (row.is_best(choice.choice)) CHECK(choice.regret.value == 1);
        CHECK(choice.reason.empty() == row.is_best(choice.choice));
        CHECK(choice.choice.prediction.threads <= row.threads);
      }
      REQUIRE(row.baselines.size() == baselines().size());
      CHECK(row.baselines[0].size() == 6);
      CHECK(row.baselines[0][0]->value == row.choices.back().regret.value);
      CHECK(row.baselines[1].size() == 1);  // usual shape
      CHECK(row.baselines[3].size() == 2);  // always Embree
      for (const BaselineRow& options : row.baselines)
        for (const auto& regret : options) CHECK(regret->value > 0);
    }
  }

  TEST_CASE("of five successive workloads, one is run with more threads, each time another") {
    for (std::size_t first = 0; first < 25; first += 5) {
      std::size_t found = 0;
      for (std::size_t i = first; i < first + 5; ++i) found += has_more_threads(i) ? 1 : 0;
      CHECK(found == 1);
      CHECK(has_more_threads(first + first / 5));
    }
  }

  TEST_CASE("a workload that a chooser refuses is skipped, with the reason") {
    const Chooser refusing{
        "refusing", [](const sim::Problem&, const Job&, int) -> Chosen { throw std::invalid_argument("too flat"); }};
    const RegretResult result =
        run_regret(std::vector{tiny_workload(false)}, std::vector{refusing}, {.costs = built_in_unit_costs()});
    CHECK(result.rows.empty());
    REQUIRE(result.skipped.size() == 1);
    CHECK(result.skipped[0].why == "too flat");
    CHECK(result.done == 1);
    CHECK_FALSE(result.stopped);
  }

  TEST_CASE("a stop request before the first workload leaves no rows") {
    std::stop_source source;
    source.request_stop();
    const RegretResult result = run_regret(std::vector{tiny_workload(false)}, all_choosers(built_in_unit_costs()),
                                           {.costs = built_in_unit_costs(), .stop = source.get_token()});
    CHECK(result.stopped);
    CHECK(result.rows.empty());
    CHECK(result.workloads == 1);
  }
}

TEST_SUITE("long") {
  TEST_CASE("the choices do not lose to the best constant, and a constant with large leaves does" *
            doctest::skip(support::sanitized)) {  // kernels are slower there, each by another factor
    std::vector<Chooser> choosers = all_choosers(built_in_unit_costs());
    const std::size_t tiers = choosers.size();
    choosers.push_back(always({Technique::box_tree, BoxTreeParameters{4, 1024}}));
    const auto workloads = regret_set(BenchEffort::quick, "").workloads;
    CHECK(support::in_attempts(3, [&] {  // on a busy machine any choice may seem wrong, once
      const RegretSummary summary =
          summarise(run_regret(workloads, choosers, {.costs = built_in_unit_costs()}).rows, 1);
      REQUIRE(summary.rows == workloads.size());
      bool right = true;
      for (std::size_t tier = 0; tier < summary.tiers.size(); ++tier) {
        if (loses(summary, tier) == (tier >= tiers)) continue;
        right = false;
        MESSAGE(summary.tiers[tier].tier, ": regret ", summary.tiers[tier].regret.all.geometric_mean,
                ", the constant's ", summary.baselines[0].regret.all.geometric_mean, ", noise ",
                summary.noise.geometric_mean);
      }
      return right;
    }));
  }
}
