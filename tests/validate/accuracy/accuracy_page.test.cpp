#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

using Error = std::function<double(const CsvRow&)>;

constexpr std::array radii_over_distance{0.25, 0.5, 1.0, 2.0};
const std::vector<std::string> estimators{"disc", "variable-radius", "area-corrected", "nearest", "triangle-hits"};

bool same_setting(const CsvRow& a, const CsvRow& b) {
  return std::ranges::all_of(std::array{"scene", "estimator", "radius_over_distance", "nearest"},
                             [&](const char* key) { return a.at(key) == b.at(key); });
}

/// Slopes of noise² in the number of rays, between 1e5 and 1e6.
std::vector<double> noise_slopes(const std::vector<CsvRow>& rows, const std::string& estimator) {
  std::vector<double> slopes;
  for (const CsvRow& many : rows)
    for (const CsvRow& few : rows)
      if (many.at("estimator") == estimator && same_setting(many, few) && number(many, "rays") == 1e6 &&
          number(few, "rays") == 1e5)
        slopes.push_back(2 * std::log10(number(many, "noise") / number(few, "noise")));
  return slopes;
}

/// Number of scenes in which discs of this radius have the least total error.
int scenes_best_at(const std::vector<CsvRow>& rows, double radius, double rays) {
  int count = 0;
  for (const CsvRow& row : rows) {
    if (row.at("estimator") != "disc" || number(row, "radius_over_distance") != radius || number(row, "rays") != rays)
      continue;
    count += std::ranges::none_of(rows, [&](const CsvRow& other) {
      return other.at("scene") == row.at("scene") && other.at("estimator") == "disc" && number(other, "rays") == rays &&
             number(other, "total") < number(row, "total");
    });
  }
  return count;
}

/// bias² + noise², with the rays that a second allows: seconds grow in proportion.
double total_in_a_second(const CsvRow& row) {
  const double seconds = number(row, "trace_seconds") + number(row, "estimate_seconds");
  return std::sqrt(std::pow(number(row, "bias"), 2) + std::pow(number(row, "noise"), 2) * seconds);
}

std::string setting(const CsvRow& row) {
  if (const double radius = number(row, "radius_over_distance"); radius > 0)
    return fmt::format(" (d = {:g} h)", radius);
  return row.at("nearest") == "0" ? "" : fmt::format(" (k = {})", row.at("nearest"));
}

/// The least error with 1e6 rays, and the setting that has it. `radius_over_distance` 0: of all settings.
std::string least(const std::vector<CsvRow>& rows, const std::string& scene, const std::string& estimator,
                  double radius_over_distance, const Error& error) {
  const CsvRow* best = nullptr;
  for (const CsvRow& row : rows) {
    if (row.at("scene") != scene || row.at("estimator") != estimator || number(row, "rays") != 1e6) continue;
    if (radius_over_distance > 0 && number(row, "radius_over_distance") != radius_over_distance) continue;
    if (best == nullptr || error(row) < error(*best)) best = &row;
  }
  REQUIRE(best != nullptr);
  return fmt::format("{:.1f} %{}", 100 * error(*best), radius_over_distance > 0 ? "" : setting(*best));
}

/// A scene's line: for each estimator the setting with the least total error, and with that in a second; then discs of half the
/// sample distance.
std::string scene_line(const std::vector<CsvRow>& rows, const std::string& scene) {
  std::string line = fmt::format("| {} |", scene);
  const auto add = [&](const std::string& estimator, double radius_over_distance) {
    const auto of = [&](const Error& error) { return least(rows, scene, estimator, radius_over_distance, error); };
    line += fmt::format(" {}; {} |", of([](const CsvRow& row) { return number(row, "total"); }), of(total_in_a_second));
  };
  for (const std::string& estimator : estimators) add(estimator, 0);
  add("disc", 0.5);
  return line;
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page's tables and figures are those of accuracy.csv") {
    const std::string page = source_text("validate/accuracy/README.md");
    const std::vector<CsvRow> rows = published("accuracy.csv");
    REQUIRE(rows.size() > 100);
    std::set<std::string> scenes;
    for (const CsvRow& row : rows) scenes.insert(row.at("scene"));
    REQUIRE(scenes.size() == 9);
    for (const std::string& scene : scenes) check_says(page, scene_line(rows, scene));
    const auto says_slopes = [&](const char* estimator) {
      const auto slopes = noise_slopes(rows, estimator);
      check_says(page, fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} |", estimator, validate::quantile(slopes, 0),
                                   validate::median(slopes), validate::quantile(slopes, 1)));
    };
    for (const char* estimator : {"disc", "area-corrected", "variable-radius", "triangle-hits"}) says_slopes(estimator);
    for (const double rays : {1e4, 1e5, 1e6}) {
      std::string line = fmt::format("| {:.0e} |", rays);
      for (const double radius : radii_over_distance) line += fmt::format(" {} |", scenes_best_at(rows, radius, rays));
      check_says(page, line);
    }
  }
}

}  // namespace detp::support
