#include "detp/validate/regret/regret.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "detp/model/rank/choose.hpp"
#include "detp/validate/bench/workload.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "detp/validate/regret/regret_answer.hpp"
#include "support/attempts.hpp"
#include "support/machine.hpp"
#include "support/regret_rows.hpp"
#include "support/workloads.hpp"

using namespace detp;
using namespace detp::validate;
using support::regret_row;

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

  TEST_CASE("figures: the geometric mean, the quantile 0.95, the worst, and the number of lower bounds") {
    const Figures figures = figures_of(std::vector<Regret>{{1}, {2}, {4, true}, {8}});
    CHECK(figures.rows == 4);
    CHECK(figures.geometric_mean == doctest::Approx(std::pow(64, 0.25)));
    CHECK(figures.p95 == doctest::Approx(4 + 0.85 * 4));
    CHECK(figures.worst == 8);
    CHECK(figures.at_least == 1);
    CHECK(figures_of({}).rows == 0);
  }

  TEST_CASE("a summary has the regret of a tier in each half, for one number of threads") {
    const std::vector<RegretRow> rows{regret_row(2, false), regret_row(8, false), regret_row(3, true),
                                      regret_row(50, true, 2, 2)};
    const RegretSummary one = summarise(rows, 1);
    CHECK(one.rows == 3);
    REQUIRE(one.tiers.size() == 1);
    CHECK(one.tiers[0].tier == "estimate");
    CHECK(one.tiers[0].regret.fitted.geometric_mean == doctest::Approx(4));
    CHECK(one.tiers[0].regret.held_out.geometric_mean == doctest::Approx(3));
    CHECK(one.tiers[0].regret.all.geometric_mean == doctest::Approx(std::cbrt(48)));
    CHECK(one.tiers[0].regret.all.worst == 8);
    const RegretSummary two = summarise(rows, 2);
    CHECK(two.tiers[0].regret.held_out.worst == 50);
    CHECK(two.tiers[0].regret.fitted.rows == 0);
    CHECK(summarise(rows, 3).rows == 0);
    CHECK(summarise(rows, 3).tiers.empty());
  }

  TEST_CASE("the constant is the option that is best on the fitted scenes, whatever it does on the others") {
    std::vector<RegretRow> rows{regret_row(1, false), regret_row(1, false), regret_row(1, true)};
    rows[0].baselines[0][3]->value = 1.5;
    rows[1].baselines[0][3]->value = 1.5;
    rows[2].baselines[0][3]->value = 100;
    rows[2].baselines[0][1]->value = 1;
    const BaselineSummary constant = summarise(rows, 1).baselines.at(0);
    CHECK(constant.option == 3);
    CHECK(constant.regret.fitted.geometric_mean == doctest::Approx(1.5));
    CHECK(constant.regret.held_out.geometric_mean == doctest::Approx(100));
  }

  TEST_CASE("lower bounds count with their value, and figures say how many; missing options do not count") {
    std::vector<RegretRow> rows{regret_row(1, false, 4), regret_row(1, true, 4)};
    rows[0].baselines[1][0] = Regret{9, true};
    rows[1].baselines[1][0].reset();
    const RegretFigures paper = summarise(rows, 1).baselines.at(1).regret;
    CHECK(paper.fitted.geometric_mean == doctest::Approx(9));
    CHECK(paper.fitted.at_least == 1);
    CHECK(paper.held_out.rows == 0);
    CHECK(paper.all.rows == 1);
  }

  TEST_CASE("the price adds the time of choosing, and only counts where the best takes at least 5 ms") {
    std::vector<RegretRow> rows{regret_row(2, false), regret_row(2, false)};
    rows[1].best_seconds = 0.001;
    const Figures price = summarise(rows, 1).tiers[0].price;
    CHECK(price.rows == 1);
    CHECK(price.geometric_mean == doctest::Approx(2.5));
  }

  TEST_CASE("errors of predicted seconds are relative to measured seconds, and leave out runs that were abandoned") {
    std::vector<RegretRow> rows{regret_row(1, false), regret_row(2, false), regret_row(4, false), regret_row(9, false)};
    rows[3].choices[0].regret.at_least = true;
    const PredictionFigures prediction = summarise(rows, 1).tiers[0].prediction;
    CHECK(prediction.rows == 3);
    CHECK(prediction.median_error == doctest::Approx(0.5));
    CHECK(prediction.p95_error == doctest::Approx(0.725));
    rows.resize(1);
    rows[0].choices[0].choice.prediction.time = {};
    CHECK(summarise(rows, 1).tiers[0].prediction.rows == 0);
  }

  TEST_CASE("noise is a factor of at least 1 in either direction") {
    std::vector<RegretRow> rows{regret_row(1, false), regret_row(1, true)};
    rows[0].noise = 0.5;
    rows[1].noise = 2;
    const Figures noise = summarise(rows, 1).noise;
    CHECK(noise.geometric_mean == doctest::Approx(2));
    CHECK(noise.worst == doctest::Approx(2));
  }

  TEST_CASE("the worst choices come first, without those that are the best") {
    std::vector<RegretRow> rows{regret_row(2, false), regret_row(8, true), regret_row(3, true), regret_row(1, true)};
    rows[3].best = rows[3].choices[0].choice.prediction.candidate;
    const auto two = worst_choices(rows, 2);
    REQUIRE(two.size() == 2);
    CHECK(two[0].row == &rows[1]);
    CHECK(two[1].row == &rows[2]);
    CHECK(worst_choices(rows, 10).size() == 3);
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
