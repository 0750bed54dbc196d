#include "detp/validate/regret/regret_answer.hpp"

#include <doctest/doctest.h>

#include "support/regret_rows.hpp"

using namespace detp;
using namespace detp::validate;
using support::regret_row;

TEST_SUITE("known answer") {
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

  TEST_CASE(
      "lower bounds count with their value, and the figures say how many there are; missing options do not count") {
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
