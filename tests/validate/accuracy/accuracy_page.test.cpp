#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "detp/validate/accuracy/accuracy_rows.hpp"
#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

namespace detp::validate {
namespace {

std::vector<AccuracyRow> published_rows() {
  std::istringstream csv(support::source_text("notebooks-data/accuracy.csv"));
  return read_accuracy_rows(csv);
}

bool same_setting(const AccuracyRow& a, const AccuracyRow& b) {
  return a.scene == b.scene && a.estimator == b.estimator && a.radius == b.radius && a.nearest == b.nearest;
}

/// Slopes of noise² in the number of rays, between 1e5 and 1e6.
std::vector<double> noise_slopes(const std::vector<AccuracyRow>& rows, const std::string& estimator) {
  std::vector<double> slopes;
  for (const AccuracyRow& many : rows)
    for (const AccuracyRow& few : rows)
      if (many.estimator == estimator && same_setting(many, few) && many.rays == 1e6 && few.rays == 1e5)
        slopes.push_back(2 * std::log10(many.noise / few.noise));
  return slopes;
}

/// Number of scenes in which discs of this radius have the least total error.
int scenes_best_at(const std::vector<AccuracyRow>& rows, double radius, double rays) {
  int count = 0;
  for (const AccuracyRow& row : rows) {
    if (row.estimator != "disc" || row.radius != radius || row.rays != rays) continue;
    bool best = true;
    for (const AccuracyRow& other : rows)
      if (other.scene == row.scene && other.estimator == "disc" && other.rays == rays && other.total < row.total)
        best = false;
    count += best ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page's tables and figures are those of accuracy.csv") {
    const std::string page = support::source_text("validate/accuracy/README.md");
    const auto rows = published_rows();
    std::istringstream summary(accuracy_summary(rows));
    for (std::string line; std::getline(summary, line);) support::check_says(page, line);
    const auto says_slopes = [&](const char* estimator) {
      const auto slopes = noise_slopes(rows, estimator);
      support::check_says(page, fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} |", estimator, quantile(slopes, 0),
                                            median(slopes), quantile(slopes, 1)));
    };
    for (const char* estimator : {"disc", "area-corrected", "variable-radius", "triangle-hits"}) says_slopes(estimator);
    for (const double rays : {1e4, 1e5, 1e6}) {
      std::string line = fmt::format("| {:.0e} |", rays);
      for (const double radius : radii_over_distance) line += fmt::format(" {} |", scenes_best_at(rows, radius, rays));
      support::check_says(page, line);
    }
  }

  TEST_CASE("a table is read back as it was written; others are refused") {
    const auto rows = published_rows();
    REQUIRE(rows.size() > 100);
    std::istringstream again(accuracy_header() + csv_row(rows[3]) + csv_row(rows[7]));
    const auto read = read_accuracy_rows(again);
    REQUIRE(read.size() == 2);
    CHECK(csv_row(read[1]) == csv_row(rows[7]));
    std::istringstream other("scene,seconds\n@tree,1\n");
    CHECK_THROWS_AS((void)read_accuracy_rows(other), std::invalid_argument);
  }
}

}  // namespace detp::validate
