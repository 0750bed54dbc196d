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

/// The root of γQ³ + 3Q - 2 by Newton's method, started at the model's value.
void compare_copies(double copy, Ledger& ledger) {
  const double found = model::optimal_ratio_with_copies(copy);
  Exact root = found;
  for (int i = 0; i < 2; ++i) root -= ((copy * root * root + 3) * root - 2) / (3 * copy * root * root + 3);
  ledger.compare("Q* with copies", found, root, [&] { return fmt::format("c/t {:a}", copy); });
}

void compare_random_ratios(Draw& draw, Ledger& ledger) {
  const double gap = draw.log_uniform(1e-17, 1);
  const double side = draw.whole(0, 1) == 0 ? -1 : 1;
  const std::int64_t kind = draw.whole(0, 3);
  const double dimension = kind == 0 ? draw.uniform(1, 3) : kind == 1 ? 2 + side * gap : kind == 2 ? 3 - gap : 1 + gap;
  compare_dimension(std::clamp(dimension, 1.0, 3.0), ledger);
  compare_copies(draw.whole(0, 1) == 0 ? draw.anywhere() : draw.log_uniform(1e-4, 1e4), ledger);
}

void compare_edge_ratios(Ledger& ledger) {
  for (const double dimension : {1.0, std::nextafter(1.0, 2.0), std::nextafter(2.0, 1.0), 2.0, std::nextafter(2.0, 3.0),
                                 std::nextafter(3.0, 2.0), 3.0})
    compare_dimension(dimension, ledger);
  for (double gap = 1e-17; gap < 2e-3; gap *= 10)
    for (const double dimension : {1 + gap, 2 - gap, 2 + gap, 3 - gap}) compare_dimension(dimension, ledger);
  for (const double copy : {0.0, 5e-324, 1e-300, 1.0 - 0x1p-53, 1.0, 1.0 + 0x1p-52, 27.0, 1e300, 1.79e308})
    compare_copies(copy, ledger);
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of Q*: D next to 1, 2 and 3, copy costs from zero to dominant") {
    Ledger ledger = on_random_inputs(3, few, compare_random_ratios);
    compare_edge_ratios(ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("Q*") { require_right_and_print(on_random_inputs(3, many, compare_random_ratios)); }
}
