#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detp/sim/search/irradiance.hpp"
#include "detp/validate/calibration/built_in_costs.hpp"
#include "support/csv_answer.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

struct Row {
  double over_one = 0;    ///< seconds over those of one band
  double over_found = 0;  ///< predicted seconds over the measured ones
};

/// Of so many bands. Predicted: the seconds of one band and sums_seconds.
std::vector<Row> rows_of(const std::vector<CsvRow>& data, double bands, const std::string& errors,
                         const std::string& fitted) {
  std::vector<Row> rows;
  double one = 0;
  for (const CsvRow& row : data) {
    if (row.at("standard_error") != errors || row.at("fitted") != fitted) continue;
    if (number(row, "bands") == 1) one = number(row, "seconds");
    if (number(row, "bands") != bands) continue;
    CostTable costs = validate::built_in_unit_costs();
    costs[Technique::box_tree].disc_test = 1e-9 * number(row, "disc_test_ns");
    validate::SumsOfSearch sums{.rays = number(row, "rays"),
                                .hits = number(row, "hits"),
                                .discs = number(row, "discs"),
                                .errors = errors == "yes",
                                .numbered = row.at("numbered") == "yes"};
    const auto blocks = sim::PhotonBlocks::for_discs(static_cast<std::size_t>(sums.discs));
    sums.blocks = 1 + static_cast<double>(blocks.of(static_cast<std::uint64_t>(number(row, "photons"))));
    const double of_one = sums_seconds(sums, costs);
    sums.bands = bands;
    rows.push_back({number(row, "seconds") / one, (one + sums_seconds(sums, costs) - of_one) / number(row, "seconds")});
  }
  return rows;
}

/// "1.13 (1.06 to 1.19)": median and range.
std::string range(const std::vector<Row>& rows, double Row::*value) {
  std::vector<double> all;
  for (const Row& row : rows) all.push_back(row.*value);
  std::ranges::sort(all);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", all[all.size() / 2], all.front(), all.back());
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page of unit costs has the figures of bands.csv") {
    const std::vector<CsvRow> data = published("bands.csv");
    const std::string page = source_text("validate/calibration/README.md");
    check_says(page, fmt::format("{:.0f} bytes more for each disc and band", sim::error_bytes));
    for (const std::string errors : {"no", "yes"})
      for (const int bands : {3, 8, 31}) {
        const std::vector<Row> fitted = rows_of(data, bands, errors, "yes");
        const std::vector<Row> others = rows_of(data, bands, errors, "no");
        std::vector<Row> all = fitted;
        all.insert(all.end(), others.begin(), others.end());
        CHECK(others.size() >= 5);
        check_says(page, fmt::format("| {} | {} | {} | {} | {} |", bands, errors, range(all, &Row::over_one),
                                     range(fitted, &Row::over_found), range(others, &Row::over_found)));
      }
  }
}

}  // namespace detp::support
