#include "detp/model/optimum/optimal_ratio.hpp"

#include <algorithm>
#include <cmath>

#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

/// (2/D)^{1/(D-2)}.
Exact exact_optimum(double dimension) {
  const Exact beyond = Exact{dimension} - 2;
  return support::exp_of(beyond == 0 ? Exact{-1} / 2 : Exact{support::log_of(2 / Exact{dimension}) / beyond});
}

void compare_dimension(double dimension, Ledger& ledger) {
  ledger.compare("Q*", model::optimal_ratio(dimension), exact_optimum(dimension),
                 [&] { return fmt::format("D {:a}", dimension); });
}

void compare_random_ratios(Draw& draw, Ledger& ledger) {
  const double gap = draw.log_uniform(1e-17, 1);
  const double side = draw.whole(0, 1) == 0 ? -1 : 1;
  const std::int64_t kind = draw.whole(0, 3);
  const double dimension = kind == 0 ? draw.uniform(1, 3) : kind == 1 ? 2 + side * gap : kind == 2 ? 3 - gap : 1 + gap;
  compare_dimension(std::clamp(dimension, 1.0, 3.0), ledger);
}

void compare_edge_ratios(Ledger& ledger) {
  for (const double dimension : {1.0, std::nextafter(1.0, 2.0), std::nextafter(2.0, 1.0), 2.0, std::nextafter(2.0, 3.0),
                                 std::nextafter(3.0, 2.0), 3.0})
    compare_dimension(dimension, ledger);
  for (double gap = 1e-17; gap < 2e-3; gap *= 10)
    for (const double dimension : {1 + gap, 2 - gap, 2 + gap, 3 - gap}) compare_dimension(dimension, ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of Q*: D next to 1, 2 and 3") {
    Ledger ledger = on_random_inputs(3, few, compare_random_ratios);
    compare_edge_ratios(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("Q*") { require_right_and_print(on_random_inputs(3, many, compare_random_ratios)); }
}
