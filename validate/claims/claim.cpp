#include "claim.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace detp::validate {
namespace {

/// Relative error that makes the negative control wrong enough to be refuted: positive if `away` is 1 (the control is
/// too large), negative if `away` is -1 (too small). The tolerance is a share of the control itself. A control that is
/// too large by o is refuted if o - tolerance (1 + o) exceeds the half width of the interval. A control that is too
/// small by o is refuted if o - tolerance (1 - o) exceeds this half width.
double control_offset(const Claim& claim, const Finding& finding, double away) {
  const double one_count = finding.batches == 0 ? 1 / std::abs(claim.predicted) : 0;
  return away * (claim.detectable + one_count) / (1 - away * finding.tolerance);
}

Claim judge_one(const Finding& finding, const FormulaValue& prediction, double width) {
  const auto verdict_on = [&](double value) { return judge(value, finding.observed, finding.tolerance, width); };
  Claim claim{.id = finding.id + "." + std::string(name(prediction.form)),
              .quantity = finding.quantity,
              .technique = finding.technique,
              .parameters = finding.parameters,
              .form = prediction.form,
              .source = prediction.source,
              .predicted = prediction.value,
              .observed = finding.observed,
              .relative_difference = finding.observed.mean / prediction.value - 1,
              .tolerance = finding.tolerance,
              .detectable = detectable_deviation(prediction.value, finding.observed, finding.tolerance, width),
              .verdict = verdict_on(prediction.value),
              .lines = finding.lines,
              .seconds = finding.seconds,
              .refinement = finding.refinement};
  claim.documented = claim.form == Form::published && claim.verdict == Verdict::refuted &&
                     std::ranges::any_of(finding.predictions, [&](const FormulaValue& other) {
                       return other.form == Form::corrected && other.value != prediction.value;
                     });
  const double away = prediction.value < finding.observed.mean ? -1 : 1;
  claim.control_offset = control_offset(claim, finding, away);
  claim.control = prediction.value * (1 + claim.control_offset);
  claim.control_verdict = verdict_on(claim.control);
  return claim;
}

}  // namespace

Claims judge_all(const std::vector<Finding>& findings, double budget) {
  int comparisons = 0;
  for (const Finding& finding : findings) comparisons += 3 * static_cast<int>(finding.predictions.size());
  Claims claims;
  for (const Finding& finding : findings) {
    const double width = finding.batches == 0 ? 0 : interval_width(budget, comparisons, finding.batches);
    for (const FormulaValue& prediction : finding.predictions) claims.push_back(judge_one(finding, prediction, width));
  }
  return claims;
}

std::string_view control_name(Verdict verdict) {
  return verdict == Verdict::refuted ? "caught" : verdict == Verdict::agrees ? "missed" : "undecided";
}

Claims those(const Claims& claims, const std::function<bool(const Claim&)>& condition) {
  Claims found;
  std::ranges::copy_if(claims, std::back_inserter(found), condition);
  return found;
}

Claims with_form(const Claims& claims, Form form) {
  return those(claims, [&](const Claim& claim) { return claim.form == form; });
}

Claims with_verdict(const Claims& claims, Verdict verdict) {
  return those(claims, [&](const Claim& claim) { return claim.verdict == verdict; });
}

Claims starting_with(const Claims& claims, const std::string& start) {
  return those(claims, [&](const Claim& claim) { return claim.id.starts_with(start); });
}

std::vector<std::string> judged_candidates(const Claims& claims) {
  std::vector<std::string> techniques;
  for (const Claim& claim : starting_with(claims, "choice."))
    if (techniques.empty() || techniques.back() != claim.technique) techniques.push_back(claim.technique);
  return techniques;
}

Claims of_candidate(const Claims& claims, const std::string& technique) {
  return starting_with(claims, "choice." + technique + ".");
}

std::size_t controls(const Claims& claims, Verdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(claims, verdict, &Claim::control_verdict));
}

}  // namespace detp::validate
