#include "detp/validate/claims/claim.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace detp;
using namespace detp::validate;

namespace {

Finding finding(double predicted, Estimate observed, double tolerance, int batches) {
  return {.id = "tests",
          .quantity = "tests",
          .predictions = {{Form::corrected, "none", predicted}},
          .observed = observed,
          .batches = batches,
          .tolerance = tolerance};
}

Claim judged(const Finding& one) { return judge_all({one}).front(); }

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a control is refuted as near to the tolerance as the noise allows; at half that distance it is not") {
    for (const double observed : {99.9, 100.1})
      for (const double tolerance : {0.02, 0.25})
        for (const double error : {0.01, 0.3, 2.0}) {
          CAPTURE(observed);
          CAPTURE(tolerance);
          CAPTURE(error);
          const Claim claim = judged(finding(100, {observed, error}, tolerance, 32));
          CHECK(claim.control_verdict == Verdict::refuted);
          CHECK(claim.control == doctest::Approx(100 * (1 + claim.control_offset)));
          CHECK((claim.control_offset > 0) == (observed < 100));
          const double nearest = tolerance / (1 - std::copysign(tolerance, claim.control_offset));
          const double nearer =
              100 * (1 + std::copysign(0.5 * (nearest + std::abs(claim.control_offset)), claim.control_offset));
          CHECK(judged(finding(nearer, {100, error}, tolerance, 32)).verdict == Verdict::undecided);
        }
  }

  TEST_CASE("the control of an exact count is one count more, or less, than the tolerance allows") {
    const Claim exact = judged(finding(10, {10, 0}, 0, 0));
    CHECK(exact.verdict == Verdict::agrees);
    CHECK(exact.control == doctest::Approx(11));
    CHECK(exact.control_verdict == Verdict::refuted);
    const Claim within = judged(finding(100, {104, 0}, 0.05, 0));
    CHECK(within.verdict == Verdict::agrees);
    CHECK(within.control == doctest::Approx(100 * (1 - 0.06 / 1.05)));
    CHECK(within.control_verdict == Verdict::refuted);
  }

  TEST_CASE("with unknown noise neither the claim nor the control is decided") {
    const Claim claim = judged(finding(100, {100, INFINITY}, 0.25, 2));
    CHECK(claim.verdict == Verdict::undecided);
    CHECK(claim.control_verdict == Verdict::undecided);
  }
}
