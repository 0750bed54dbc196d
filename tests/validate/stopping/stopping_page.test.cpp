#include <doctest/doctest.h>
#include <fmt/format.h>

#include <boost/math/special_functions/gamma.hpp>
#include <map>
#include <string>
#include <vector>

#include "detp/validate/statistics/statistics.hpp"
#include "support/pages.hpp"

namespace detp::support {
namespace {

/// Least number of hits whose Gamma Bernoulli estimate has the error with 95 % (huber2017): (k - 1)/G, G of shape k, is within 1 ± error.
unsigned gamma_bernoulli_hits(double error) {
  const auto kept = [&](double k) {
    return boost::math::gamma_p(k, (k - 1) / (1 - error)) - boost::math::gamma_p(k, (k - 1) / (1 + error));
  };
  unsigned hits = 2;
  while (kept(hits) < 0.95) ++hits;
  return hits;
}

/// The runs of one scene, estimator and target with one rule.
struct Runs {
  int count = 0;
  int below = 0;   ///< the target
  int inside = 0;  ///< the stated interval of the noise
  std::vector<double> rays;

  void add(const CsvRow& row) {
    const double error = number(row, "error");
    ++count;
    below += error <= number(row, "target") ? 1 : 0;
    inside += number(row, "noise_low") <= error && error <= number(row, "noise_high") ? 1 : 0;
    rays.push_back(number(row, "rays"));
  }
  [[nodiscard]] double median_rays() const { return validate::median(rays); }
};

struct BothRules {
  Runs planned;
  Runs naive;
};

}  // namespace

TEST_SUITE("figures") {
  TEST_CASE("the page's runs in scenes are those of stopping.csv") {
    const std::string page = source_text("validate/stopping/README.md");
    std::map<std::string, BothRules> cases;
    BothRules all;
    for (const CsvRow& row : published("stopping.csv")) {
      const bool naive = row.at("rule") == "naive";
      BothRules& one =
          cases[fmt::format("| {} | {} | {:.0f} %", row.at("scene"), row.at("estimator"), 100 * number(row, "target"))];
      for (BothRules* rules : {&one, &all}) (naive ? rules->naive : rules->planned).add(row);
    }
    REQUIRE(cases.size() >= 6);
    for (const auto& [name, one] : cases)
      check_says(page, fmt::format("{} | {} of {} | {} of {} | {:.2g} | {} of {} | {:.2g} |", name, one.planned.below,
                                   one.planned.count, one.planned.inside, one.planned.count, one.planned.median_rays(),
                                   one.naive.below, one.naive.count, one.naive.median_rays()));
    check_says(page, fmt::format("{} of {} runs end below the target, {} with the naive rule", all.planned.below,
                                 all.planned.count, all.naive.below));
    CHECK(all.planned.below >= 0.92 * all.planned.count);  // 276 of 300
  }

  TEST_CASE("the page's rules for one mean are those of stopping_rules.csv") {
    const std::string page = source_text("validate/stopping/README.md");
    std::vector<std::string> rules;
    std::map<std::string, std::string> lines;
    for (const CsvRow& row : published("stopping_rules.csv")) {
      const std::string& rule = row.at("rule");
      if (!lines.contains(rule)) rules.push_back(rule);
      std::string& line = lines.try_emplace(rule, "| " + rule + " |").first->second;
      line += fmt::format(" {:.1f} % ({:.2f}) |", 100 * number(row, "inside") / number(row, "runs"),
                          number(row, "size_over_best"));
    }
    for (const std::string& rule : rules) check_says(page, lines.at(rule));
    check_says(page, fmt::format("k = {}, {}, {} for 10, 5, 2 %", gamma_bernoulli_hits(0.1), gamma_bernoulli_hits(0.05),
                                 gamma_bernoulli_hits(0.02)));
  }
}

}  // namespace detp::support
