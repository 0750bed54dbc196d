#include <doctest/doctest.h>
#include <fmt/format.h>

#include <boost/math/special_functions/gamma.hpp>
#include <map>
#include <string>
#include <vector>

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

}  // namespace

TEST_SUITE("published stopping") {
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
