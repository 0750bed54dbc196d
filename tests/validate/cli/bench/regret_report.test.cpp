#include "detp/validate/cli/bench/bench_report.hpp"

#include <doctest/doctest.h>

#include "support/csv_answer.hpp"
#include "support/regret_rows.hpp"

namespace detp::support {
namespace {

cli::Result report_of(std::vector<validate::RegretRow> rows, const std::vector<int>& threads = {1}) {
  validate::RegretAnswer answer{.set = {{}, {"sponza: not here"}}, .threads = threads};
  answer.result.rows = std::move(rows);
  answer.result.workloads = answer.result.done = answer.result.rows.size();
  answer.summarise_all();
  return cli::report(answer, {});
}

validate::RegretRow at_least(validate::RegretRow row) {
  row.baselines.back()[0]->at_least = true;
  return row;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("the JSON of --regret has the figures of tiers and baselines, in all and by halves and threads") {
    const auto json = report_of({regret_row(2, false), regret_row(8, true), regret_row(3, true, 2, 2)}, {1, 2}).json;
    const auto& regret = json.at("summary").at("regret");
    for (const char* who :
         {"estimate", "best_constant", "usual_shape", "paper_rule", "always_embree", "always_brute_force"})
      for (const char* figure : {"geometric_mean", "p95", "worst"}) {
        CHECK(regret.at(who).at(figure).get<double>() > 1);
        CHECK(regret.at(who).at("fitted").contains(figure));
        CHECK(regret.at(who).at("held_out").contains(figure));
      }
    CHECK(regret.at("estimate").at("geometric_mean").get<double>() == doctest::Approx(4));
    CHECK(regret.at("estimate").at("fitted").at("worst") == 2);
    CHECK(regret.at("estimate").at("held_out").at("worst") == 8);
    CHECK(regret.at("best_constant").at("technique") == "box-tree");
    CHECK_FALSE(regret.at("paper_rule").contains("technique"));
    CHECK(json.at("summary").at("prediction").at("median_error").get<double>() == doctest::Approx(0.6875));
    CHECK(json.at("summary").at("prediction").contains("p95_error"));
    CHECK(json.at("summary").at("price").at("geometric_mean").get<double>() == doctest::Approx(std::sqrt(2.5 * 8.5)));
    CHECK(json.at("summary").at("noise").at("geometric_mean") == 1);
    REQUIRE(json.at("summary").at("by_threads").size() == 2);
    CHECK(json.at("summary").at("by_threads")[1].at("regret").at("estimate").at("worst") == 3);
    CHECK(json.at("rows").size() == 3);
    CHECK(json.at("left_out").size() == 1);
  }

  TEST_CASE("the CSV of --regret has a row for each workload, number of threads and tier") {
    const auto rows = csv_records(report_of({at_least(regret_row(2, false)), regret_row(8, true)}).csv);
    REQUIRE(rows.size() == 3);
    CHECK(rows[0].front() == "scene");
    CHECK(rows[0].back() == "reason");
    const auto field = [&](std::size_t row, const std::string& column) {
      const auto place = std::find(rows[0].begin(), rows[0].end(), column) - rows[0].begin();
      REQUIRE(place < std::ssize(rows[0]));
      return rows[row].at(static_cast<std::size_t>(place));
    };
    CHECK(field(1, "scene") == "@tree");
    CHECK(field(1, "held_out") == "false");
    CHECK(field(2, "held_out") == "true");
    CHECK(field(1, "rays") == "1200");
    CHECK(field(1, "tier") == "estimate");
    CHECK(field(1, "technique") == "box-tree");
    CHECK(field(1, "best_technique") == "grid");
    CHECK(field(1, "regret") == "2");
    CHECK(field(1, "always_brute_force_regret") == "2");
    CHECK(field(1, "always_brute_force_abandoned") == "true");
    CHECK(field(2, "always_brute_force_abandoned") == "false");
    CHECK(field(1, "reason") == "unit costs");
  }

  TEST_CASE("the text of --regret has a line for each tier and baseline, marks lower bounds, and lists the worst") {
    const std::string text = report_of({at_least(regret_row(2, false)), regret_row(8, true)}).text;
    CAPTURE(text);
    CHECK(text.find("best constant") != std::string::npos);
    CHECK(text.find(">= 2") != std::string::npos);
    CHECK(text.find("at least") != std::string::npos);
    CHECK(text.find("The 2 largest regrets") != std::string::npos);
    CHECK(text.find("left out  sponza: not here") != std::string::npos);
    CHECK_FALSE(has_no_number(text));
  }

  TEST_CASE("without rows, the report of --regret has no figures and is no error") {
    const cli::Result empty = report_of({});
    CHECK(empty.json.at("rows").empty());
    CHECK(empty.json.at("summary").at("regret").empty());
    CHECK(empty.text.find("0 workloads") != std::string::npos);
  }
}

}  // namespace detp::support
