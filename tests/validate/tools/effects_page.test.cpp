#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

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

}  // namespace

TEST_SUITE("figures of pages") {
  TEST_CASE("the page of the effects' study has the figures of effects_families.csv") {
    const std::string page = source_text("validate/tools/effects_study/README.md");
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
    check_says(page, fmt::format("off by {:.2f} in the median (seed 41) instead of {:.2f}",
                                 validate::median(automatic.off), validate::median(none.off)));
    check_says(page, fmt::format("{:.1f} % instead of {:.1f} % (seed 41)", 100 * (geometric_mean(automatic.price) - 1),
                                 100 * (geometric_mean(none.price) - 1)));
  }
}

}  // namespace detp::support
