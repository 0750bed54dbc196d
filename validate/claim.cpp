#include "claim.hpp"

#include <cmath>

namespace detp::validate {
namespace {

/// How kind a verdict is: agrees before undecided before refuted.
int kindness(Verdict verdict) { return verdict == Verdict::agrees ? 2 : (verdict == Verdict::undecided ? 1 : 0); }

Claim judge_one(const Finding& finding, const Prediction& prediction, double width) {
  const auto verdict_on = [&](double value) { return judge(value, finding.observed, finding.tolerance, width); };
  Claim claim{.id = finding.id + "." + std::string(name(prediction.form)),
              .quantity = finding.quantity,
              .form = prediction.form,
              .source = prediction.source,
              .predicted = prediction.value,
              .observed = finding.observed,
              .relative_difference = finding.observed.mean / prediction.value - 1,
              .tolerance = finding.tolerance,
              .detectable = detectable_deviation(prediction.value, finding.observed, finding.tolerance, width),
              .verdict = verdict_on(prediction.value),
              .lines = finding.lines,
              .seconds = finding.seconds};
  const double more = prediction.value * (1 + control_error);
  const double less = prediction.value * (1 - control_error);
  claim.control = kindness(verdict_on(more)) >= kindness(verdict_on(less)) ? more : less;
  claim.control_verdict = verdict_on(claim.control);
  return claim;
}

}  // namespace

std::vector<Claim> judge_all(const std::vector<Finding>& findings, double budget) {
  int comparisons = 0;
  for (const Finding& finding : findings) comparisons += 3 * static_cast<int>(finding.predictions.size());
  std::vector<Claim> claims;
  for (const Finding& finding : findings) {
    const double width = finding.batches == 0 ? 0 : interval_width(budget, comparisons, finding.batches);
    for (const Prediction& prediction : finding.predictions) claims.push_back(judge_one(finding, prediction, width));
  }
  return claims;
}

}  // namespace detp::validate
