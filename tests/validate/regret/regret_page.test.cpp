#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "detp/validate/regret/regret_answer.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

using namespace detp;
using namespace detp::validate;
using support::check_says;
using support::CsvRow;
using support::number;
using support::published;
using support::source_text;

namespace {

/// The rows of a file, as far as figures need them. A baseline has one option, the one that counts.
std::vector<RegretRow> published_regrets(const std::string& file = "regret.csv") {
  std::vector<RegretRow> rows;
  for (const CsvRow& fields : published(file)) {
    if (rows.empty() || fields.at("tier") == rows.front().choices.front().tier) {
      RegretRow& row = rows.emplace_back();
      row.workload.scene = fields.at("scene");
      row.workload.held_out = fields.at("held_out") == "true";
      row.workload.field = fields.at("field") == "photons" ? sim::Field::photons : sim::Field::isotropic;
      row.threads = std::stoi(fields.at("threads"));
      row.best_seconds = number(fields, "best_seconds");
      row.noise = number(fields, "noise");
      for (const Baseline& baseline : baselines()) {
        const std::string name(baseline.name);
        std::optional<Regret> regret;
        if (!fields.at(name + "_regret").empty())
          regret = Regret{number(fields, name + "_regret"), fields.at(name + "_abandoned") == "true"};
        row.baselines.push_back({regret});
      }
    }
    ChoiceRow& choice = rows.back().choices.emplace_back();
    choice.tier = fields.at("tier");
    choice.choice.prediction.time.intersect =
        fields.at("predicted_seconds").empty() ? 0 : number(fields, "predicted_seconds");
    choice.choice.choosing_seconds = number(fields, "choosing_seconds");
    choice.seconds = number(fields, "seconds");
    choice.regret = {number(fields, "regret"), fields.at("abandoned") == "true"};
  }
  return rows;
}

/// Those of one half of the scenes, on one thread.
std::vector<RegretRow> half_of(const std::vector<RegretRow>& rows, bool held_out) {
  std::vector<RegretRow> some;
  for (const RegretRow& row : rows)
    if (row.workload.held_out == held_out && row.threads == 1) some.push_back(row);
  return some;
}

/// (Choosing + run) over the best, where the best takes at least `least` seconds.
Figures price_of(const std::vector<RegretRow>& rows, std::size_t tier, double least) {
  std::vector<Regret> prices;
  for (const RegretRow& row : rows) {
    if (row.best_seconds < least) continue;
    const ChoiceRow& choice = row.choices[tier];
    prices.push_back({(choice.choice.choosing_seconds + choice.seconds) / row.best_seconds});
  }
  return figures_of(prices);
}

std::string figure(double value) { return value < 10 ? fmt::format("{:.2f}", value) : fmt::format("{:.1f}", value); }

std::string cells_of(const Figures& figures) {
  return fmt::format("{} | {} | {}", figure(figures.geometric_mean), figure(figures.p95), figure(figures.worst));
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("validate/regret/README.md shows the regrets, prices and errors that regret.csv has") {
    const std::string page = source_text("validate/regret/README.md");
    const auto rows = published_regrets();
    const auto held_out = half_of(rows, true);
    const RegretSummary one = summarise(rows, 1);
    const RegretSummary two = summarise(rows, 2);
    check_says(
        page,
        fmt::format("{} workloads on one thread, {} of fitted and {} of held-out scenes, and {} of them also on two",
                    one.rows, one.rows - held_out.size(), held_out.size(), two.rows));
    const auto both = [](const RegretFigures& regret) {
      return cells_of(regret.fitted) + " | " + cells_of(regret.held_out);
    };
    const auto prices = [&](std::size_t tier) {
      return cells_of(price_of(held_out, tier, 0)) + " | " + cells_of(price_of(held_out, tier, shortest_priced_run));
    };
    for (std::size_t i = 0; i < one.tiers.size(); ++i) {
      const TierSummary& tier = one.tiers[i];
      check_says(page,
                 fmt::format("| {} | {} | {} |\n", tier.tier, both(tier.regret), cells_of(two.tiers[i].regret.all)));
      check_says(page,
                 fmt::format("| {} | {} | {} | {:.0f} % | {:.0f} % |\n", tier.tier, prices(i), tier.prediction.rows,
                             100 * tier.prediction.median_error, 100 * tier.prediction.p95_error));
    }
    for (std::size_t i = 0; i < one.baselines.size(); ++i) {
      const RegretFigures& regret = one.baselines[i].regret;
      const bool has_two = baselines()[i].name == "best_constant";
      check_says(page,
                 fmt::format("| {}{} | {} | {} |\n", baselines()[i].text, regret.all.at_least > 0 ? ", at least" : "",
                             both(regret), has_two ? cells_of(two.baselines[i].regret.all) : "| |"));
    }
    check_says(page, fmt::format("| noise | {} | {} | {} |\n", cells_of(summarise(half_of(rows, false), 1).noise),
                                 cells_of(summarise(held_out, 1).noise), cells_of(two.noise)));
  }

  TEST_CASE("validate/regret/README.md shows the regrets and prices that regret_families.csv has") {
    const std::string page = source_text("validate/regret/README.md");
    const auto rows = published_regrets("regret_families.csv");
    const RegretSummary summary = summarise(rows, 1);
    for (std::size_t i = 0; i < summary.tiers.size(); ++i)
      check_says(page, fmt::format("| {} | {} | {} |\n", summary.tiers[i].tier, cells_of(summary.tiers[i].regret.all),
                                   cells_of(price_of(rows, i, 0))));
    for (std::size_t i = 0; i < summary.baselines.size(); ++i)
      if (baselines()[i].name == "best_constant" || baselines()[i].name == "usual_shape")
        check_says(page,
                   fmt::format("| {} | {} | | | |\n", baselines()[i].text, cells_of(summary.baselines[i].regret.all)));
  }

  TEST_CASE("trust.md and README.md say how near the choice of detp run is to the best, as regret.csv has it") {
    const std::string page = source_text("validate/trust.md");
    const auto held_out = half_of(published_regrets(), true);
    REQUIRE_FALSE(held_out.empty());
    const auto& choices = held_out.front().choices;
    const auto run = static_cast<std::size_t>(std::ranges::find(choices, "run", &ChoiceRow::tier) - choices.begin());
    const Figures price = price_of(held_out, run, 0);
    check_says(page, fmt::format("[{} workloads of held-out scenes](", price.rows));
    const auto row = [&](const std::string& what, const Figures& figures) {
      check_says(page, fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} |\n", what, figures.geometric_mean, figures.p95,
                                   figures.worst));
    };
    check_says(source_text("README.md"),
               fmt::format("| {:.2f} in the middle, {:.2f} at worst |", price.geometric_mean, price.worst));
    row("Time of choosing and running with `detp run`, over that of the best candidate", price);
    row("the same where the best takes at least 5 ms", price_of(held_out, run, shortest_priced_run));
    std::vector<Regret> constant;
    for (const RegretRow& one : held_out) constant.push_back(one.baselines.front().front().value());
    row("Time of the best constant, a box tree of one shape, over that of the best candidate", figures_of(constant));
  }
}
