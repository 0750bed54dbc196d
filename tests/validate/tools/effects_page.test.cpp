#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "detp/sim/effects/effect.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

double geometric_mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

/// Of the choices with these effects ("auto", "all", "none"): how far predicted tests are off, time over the best, and the same with the
/// evidence, of which "none" needs none.
struct OfSelection {
  std::vector<double> off;
  std::vector<double> time;
  std::vector<double> price;
};

OfSelection selected(const std::string& selection) {
  OfSelection all;
  for (const CsvRow& row : published("effects_families.csv")) {
    const double ratio = number(row, "predicted_over_counted_" + selection);
    all.off.push_back(std::max(ratio, 1 / ratio));
    all.time.push_back(1 + number(row, "regret_" + selection));
    const double evidence = selection == "none" ? 0 : number(row, "evidence_seconds_" + selection);
    all.price.push_back(all.time.back() + evidence / number(row, "best_seconds"));
  }
  return all;
}

std::string effects_page() { return source_text(std::string("notebooks-data/studies/") + "effects.md"); }

/// Percent by which the geometric mean is above 1: "1.2".
std::string percent_above(const std::vector<double>& ratios) {
  return fmt::format("{:.1f}", 100 * (geometric_mean(ratios) - 1));
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page of the effects' study has the figures of effects_families.csv") {
    const std::string page = effects_page();
    for (const std::string selection : {"auto", "all", "none"}) {
      const OfSelection found = selected(selection);
      const auto worst = [](const std::vector<double>& values) { return *std::ranges::max_element(values); };
      check_says(page, fmt::format("| predicted over counted tests, {}: median, worst | {:.3f}, {:.2f} |", selection,
                                   validate::median(found.off), worst(found.off)));
      check_says(page, fmt::format("| time over the best, {}: geometric mean, worst | {:.4f}, {:.2f} |", selection,
                                   geometric_mean(found.time), worst(found.time)));
      check_says(page, fmt::format("| with the evidence, {}: geometric mean, worst | {:.4f}, {:.2f} |", selection,
                                   geometric_mean(found.price), worst(found.price)));
    }
    const OfSelection automatic = selected("auto");
    const OfSelection none = selected("none");
    check_says(page, fmt::format("off by {:.2f} in the median (seed 42) instead of {:.2f}",
                                 validate::median(automatic.off), validate::median(none.off)));
    check_says(page, fmt::format("lose {} % on seed 42, with the effects of the evidence {} %",
                                 percent_above(none.time), percent_above(automatic.time)));
    check_says(
        page, fmt::format("{} % instead of {} % (seed 42)", percent_above(automatic.price), percent_above(none.price)));
    std::vector<double> by_rule;
    std::vector<double> evidence;
    for (const CsvRow& row : published("effects_families.csv")) {
      const bool pays = sim::evidence_can_pay(number(row, "rays"), number(row, "samples"));
      by_rule.push_back((pays ? automatic : none).price[by_rule.size()]);
      evidence.push_back(1e3 * number(row, "evidence_seconds_auto"));
    }
    check_says(page, fmt::format("that rule loses {} % (seed 42)", percent_above(by_rule)));
    const std::string effects = source_text("sim/effects/README.md");
    check_says(effects,
               fmt::format("{:.2f} ms in the median of {} workloads", validate::median(evidence), evidence.size()));
    check_says(effects, fmt::format("{:.2f} ms at the 95th percentile, {:.2f} ms at most",
                                    validate::quantile(evidence, 0.95), *std::ranges::max_element(evidence)));
  }

  TEST_CASE(
      "the page of the effects' study says what effects gain in pathological scenes, as effects_choice.csv has it") {
    std::vector<double> with;
    std::vector<double> without;
    for (const CsvRow& row : published("effects_choice.csv")) {
      if (row.at("tuned") == "true") continue;
      with.push_back(1 + number(row, "regret_auto"));
      without.push_back(1 + number(row, "regret_none"));
    }
    check_says(effects_page(),
               fmt::format("loses {} % without, {} % with", percent_above(without), percent_above(with)));
  }
}

}  // namespace detp::support
