#include "detp/validate/regret/regret.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "detp/model/rank/choose.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::validate;

namespace {

const Workload& reason_workload = support::typical;

/// A candidate whose counts and seconds are as predicted.
Timed as_predicted(const Candidate& candidate) {
  const Prediction ranked = model::assess(reason_workload, candidate, built_in_unit_costs());
  Timed one{.contender = {candidate}, .judging = {ranked.time.total()}};
  for (const auto& [name, term] : count_terms<double>) {
    for (const auto& [other, counted] : count_terms<std::uint64_t>)
      if (other == name) one.counts.*counted = static_cast<std::uint64_t>(std::llround(ranked.counts.*term));
  }
  return one;
}

/// The choice is the faster of the two by prediction.
struct ChoiceAndBest {
  Timed choice = as_predicted({Technique::box_tree, BoxTreeParameters{8, 32}});
  Timed best = as_predicted({Technique::box_tree, BoxTreeParameters{4, 256}});

  [[nodiscard]] std::string reason(double noise = 1.01) const {
    return reason_of_regret(reason_workload, built_in_unit_costs(), choice, best, noise);
  }
};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a choice that is the best, or as fast within the noise, has no other reason") {
    ChoiceAndBest two;
    REQUIRE(two.choice.judging[0] < two.best.judging[0]);
    two.best.judging[0] = two.choice.judging[0] / 1.05;
    CHECK(two.reason(1.1) == "within the noise");
    CHECK(two.reason(1 / 1.1) == "within the noise");
    two.best = two.choice;
    CHECK(two.reason() == "");
  }

  TEST_CASE("if right counts misprice the choice, the reason is its unit costs") {
    ChoiceAndBest two;
    two.choice.judging[0] = 4 * two.best.judging[0];
    CHECK(two.reason().starts_with("unit costs: right counts give 0."));
    CHECK(two.reason().find(", 1 times the best's") != std::string::npos);
  }

  TEST_CASE("if the choice does more than predicted, the reason is its worst count") {
    ChoiceAndBest two;
    two.choice.counts.disc_tests *= 10;
    two.choice.judging[0] = price(as_expected(two.choice.counts), built_in_unit_costs(), Technique::box_tree).total();
    REQUIRE(two.choice.judging[0] > two.best.judging[0]);
    CHECK(two.reason() == "counts: disc_tests of the choice predicted 0.1 times");
  }

  TEST_CASE("a best that the ranking could not or did not try is a reason of its own") {
    ChoiceAndBest two;
    std::swap(two.choice, two.best);
    CHECK(two.reason().starts_with("the best was not tried: predicted 0."));
    two.best.contender.candidate = default_candidate(Technique::bvh);
    CHECK(two.reason() == "bvh, quality low has no closed form");
  }

  TEST_CASE("a choice that differs from the best only in the number of threads says so") {
    ChoiceAndBest two;
    two.choice = two.best;
    two.choice.contender.threads = 4;
    two.choice.judging[0] *= 2;
    CHECK(two.reason() == "costs of threads: 4 chosen, the best takes 1");
  }

  TEST_CASE("a choice that was abandoned has no counts to compare") {
    ChoiceAndBest two;
    two.choice.abandoned = true;
    two.choice.first_seconds = 1000;
    CHECK(two.reason().starts_with("the choice was abandoned after 1e+03 s, predicted "));
  }
}
