#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

bool is_inside(const CsvRow& row) {
  return number(row, "true_bias") >= number(row, "bias_low") && number(row, "true_bias") <= number(row, "bias_high");
}

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page's table of stated and true bias is that of bias.csv") {
    const std::string page = source_text("validate/accuracy/README.md");
    const std::vector<CsvRow> rows = published("bias.csv");
    REQUIRE(rows.size() == 540);
    for (const char* scene : {"furnace", "middle of a wall", "lamp", "lamp and board", "point", "two rooms"}) {
      std::vector<CsvRow> own;
      std::ranges::copy_if(rows, std::back_inserter(own), [&](const CsvRow& row) { return row.at("scene") == scene; });
      REQUIRE(own.size() == 90);
      std::vector<double> half;
      std::vector<double> truth;
      for (const CsvRow& row : own) {
        half.push_back(50 * (number(row, "bias_high") - number(row, "bias_low")));
        truth.push_back(100 * number(row, "true_bias"));
      }
      check_says(page,
                 fmt::format("| {} | {:.2g} to {:.2g} % | {} of 90 | {:.2g} % | {:.2g} % |", scene,
                             std::ranges::min(truth), std::ranges::max(truth), std::ranges::count_if(own, is_inside),
                             validate::median(half), std::ranges::max(half)));
    }
    const auto inside = std::ranges::count_if(rows, is_inside);
    check_says(page, fmt::format("{} of 540", inside));
    CHECK(inside >= 497);  // 92 %
  }

  TEST_CASE("the page's table of gather is that of gather.csv") {
    const std::string page = source_text("validate/accuracy/README.md");
    const auto cell = [](const CsvRow& row, const char* column, double factor, const char* unit) {
      return row.at(column).empty() ? std::string("–") : fmt::format("{:.2g}{}", factor * number(row, column), unit);
    };
    for (const CsvRow& row : published("gather.csv"))
      if (row.at("paths").empty())
        check_says(page, fmt::format("| {} | left out: misses up to {:.2g} % | | |", row.at("scene"),
                                     100 * number(row, "missed_bound")));
      else
        check_says(page, fmt::format("| {} | {} | {} | {} |", row.at("scene"), row.at("paths"),
                                     cell(row, "noise_of_run", 100, " %"), cell(row, "seconds", 1, "")));
  }
}

}  // namespace detp::support
