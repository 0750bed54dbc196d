#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

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

TEST_SUITE("figures") {
  TEST_CASE("trust.md says how far closed forms are off, as effects_choice.csv has it, and README.md the same") {
    const std::string page = source_text("validate/trust.md");
    std::map<std::string, std::vector<double>> off;  // by field
    std::pair<double, std::string> worst;            // and its scene
    double worst_elsewhere = 1;
    const auto rows = published("effects_choice.csv");
    const auto factor = [](const CsvRow& row) {
      const double ratio = number(row, "predicted_over_counted_auto");
      return std::max(ratio, 1 / ratio);
    };
    for (const CsvRow& row : rows) {
      if (row.at("tuned") == "true") continue;
      off[row.at("field")].push_back(factor(row));
      worst = std::max(worst, {factor(row), row.at("scene")});
    }
    for (const CsvRow& row : rows)
      if (row.at("tuned") != "true" && row.at("scene") != worst.second)
        worst_elsewhere = std::max(worst_elsewhere, factor(row));
    const auto& lines = off.at("isotropic");
    const auto& paths = off.at("photons");
    check_says(page, fmt::format("[{} workloads of held-out scenes](", lines.size() + paths.size()));
    const auto cells = [](const std::vector<double>& factors) {
      return fmt::format("| {:.2f} | {:.2f} | {:.2f} |\n", median(factors), quantile(factors, 0.95),
                         quantile(factors, 1));
    };
    check_says(page, "predicted by closed forms over counted or the inverse, lines " + cells(lines) +
                         "| the same, photon paths " + cells(paths));
    check_says(source_text("README.md"), fmt::format("photon paths | off by {:.2f} in the middle, {:.2f} at worst |",
                                                     median(paths), quantile(paths, 1)));
    check_says(page, fmt::format("discs in {}, ", worst.second));
    check_says(page, fmt::format("In all other scenes, {:.2f} times at worst", worst_elsewhere));
  }

  TEST_CASE("trust.md and README.md say how long Embree takes, as bench.csv has it") {
    std::vector<Regret> times;
    std::set<std::string> ours;
    for (const CsvRow& row : published("bench.csv")) {
      times.push_back({number(row, "ours_seconds") / number(row, "embree_seconds")});
      ours.insert(row.at("ours"));
    }
    const Figures figures = figures_of(times);
    const std::string page = source_text("validate/trust.md");
    check_says(page, fmt::format("[{} workloads](", figures.rows));
    check_says(page, fmt::format("| Time of Embree 3.13 over that of our fastest technique | {:.1f} | | {:.2f} |\n",
                                 1 / figures.geometric_mean, 1 / figures.worst));
    check_says(source_text("README.md"), fmt::format("Embree 3.13 over ours | {:.1f} in the middle, {:.2f} at worst |",
                                                     1 / figures.geometric_mean, 1 / figures.worst));
    CHECK(ours == std::set<std::string>{"box-tree"});
  }
}
