#include "validate_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "detp/validate/cli/report/effects_report.hpp"
#include "detp/validate/cli/text/table.hpp"

namespace detp::cli {
namespace {

using validate::Claim;
using validate::Claims;
using validate::Verdict;

/// Corrected forms that are neither of a candidate nor of the effects.
Claims formulas(const Claims& claims) {
  return those(claims, [](const Claim& claim) {
    return claim.form == Form::corrected && !claim.id.starts_with("choice.") && !claim.id.starts_with("effects.");
  });
}

/// "disc-tests (counted 1.3 times the prediction)"
std::string with_factor(const Claim& claim) {
  const std::string whole = claim.stem();
  const std::string quantity = whole.substr(whole.rfind('.') + 1);
  const double factor = claim.relative_difference + 1;
  return std::isfinite(factor) ? fmt::format("{} (counted {:.2g} times the prediction)", quantity, factor) : quantity;
}

/// "; refuted: …"; empty if no claim has this verdict.
template <class Words>
std::string those_that_are(Verdict verdict, const Claims& claims, const Words& words) {
  const Claims found = with_verdict(claims, verdict);
  return found.empty() ? "" : fmt::format("; {}: {}", name(verdict), words(found));
}

/// ", 5 are undecided"; empty if none is.
std::string undecided(const Claims& claims) {
  const std::size_t count = with_verdict(claims, Verdict::undecided).size();
  return count == 0 ? "" : fmt::format(", {} {} undecided", count, count == 1 ? "is" : "are");
}

std::string agreeing(const Claims& claims) {
  return fmt::format("{} of {} predictions agree", with_verdict(claims, Verdict::agrees).size(), claims.size());
}

std::string listed_with_factors(const Claims& claims) {
  std::vector<std::string> words;
  for (const Claim& claim : claims) words.push_back(with_factor(claim));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// "rebuild-time"; without the technique that its id may start with: "tests-per-line" of an octree
std::string quantity_of(const Claim& claim) {
  const std::string whole = claim.stem();
  const std::string start = claim.technique + "-";
  return !claim.technique.empty() && whole.starts_with(start) ? whole.substr(start.size()) : whole;
}

/// "sphere-cache: rebuilds, rebuild-time; octree: tests-per-line"
std::string listed_by_technique(const Claims& claims) {
  std::string text;
  std::string technique;
  for (const Claim& claim : claims) {
    if (text.empty() || claim.technique != technique)
      text += fmt::format("{}{} {}", text.empty() ? "" : "; ",
                          claim.technique.empty() ? "lines:" : claim.technique + ":", quantity_of(claim));
    else
      text += ", " + quantity_of(claim);
    technique = claim.technique;
  }
  return text;
}

/// "; refuted: …; undecided: …"; empty if all claims agree.
std::string failures(const Claims& claims) {
  return those_that_are(Verdict::refuted, claims, listed_with_factors) +
         those_that_are(Verdict::undecided, claims, listed_with_factors);
}

std::string choice_text(const Claims& claims, const std::string& technique) {
  const Claims of_choice = of_candidate(claims, technique);
  const std::string& parameters = of_choice.front().parameters;
  return fmt::format("choice    {}{}{}, the fastest by the closed forms: {}{}\n", technique,
                     parameters.empty() ? "" : ", ", parameters, agreeing(of_choice), failures(of_choice));
}

std::string others_text(const Claims& claims, const std::vector<std::string>& techniques) {
  std::vector<std::string> words;
  for (std::size_t i = 1; i < techniques.size(); ++i) {
    const Claims all = of_candidate(claims, techniques[i]);
    const std::size_t refuted = with_verdict(all, Verdict::refuted).size();
    words.push_back(fmt::format("{} {} of {}", techniques[i], refuted, all.size()));
  }
  return words.empty() ? "" : fmt::format("others    predictions refuted: {}\n", fmt::join(words, ", "));
}

std::string published_text(const Claims& claims) {
  const Claims published = with_form(claims, Form::published);
  if (published.empty()) return "";
  std::string text =
      fmt::format("published {} of {} forms of the paper agree{}", with_verdict(published, Verdict::agrees).size(),
                  published.size(), undecided(published));
  const Claims documented = those(published, [](const Claim& claim) { return claim.documented; });
  const Claims others = those(published, [](const Claim& claim) { return !claim.documented; });
  if (!documented.empty()) text += "; refuted, as documented: " + listed_by_technique(documented);
  return text + those_that_are(Verdict::refuted, others, listed_by_technique) + "\n";
}

/// ", 2 to 10 %,"; empty if no control has a finite relative error.
std::string range_of_controls(const Claims& claims) {
  double least = INFINITY;
  double most = 0;
  for (const Claim& claim : claims)
    if (std::isfinite(claim.control_offset)) {
      least = std::min(least, std::abs(claim.control_offset));
      most = std::max(most, std::abs(claim.control_offset));
    }
  return least <= most ? fmt::format(", {:.3g} to {:.3g} %,", 100 * least, 100 * most) : "";
}

std::string controls_text(const Claims& claims) {
  std::string text = fmt::format("controls  {} of {} formulas made wrong by what is just detectable{} were caught",
                                 controls(claims, Verdict::refuted), claims.size(), range_of_controls(claims));
  if (const std::size_t missed = controls(claims, Verdict::agrees); missed > 0)
    text += fmt::format("; {} missed", missed);
  return text + "\n";
}

std::string answer_text(const Claims& claims, const Claims& of_choice) {
  const Claims corrected = with_form(claims, Form::corrected);
  const std::size_t refuted = with_verdict(corrected, Verdict::refuted).size();
  const std::size_t of_these = with_verdict(of_choice, Verdict::refuted).size();
  const std::string others =
      fmt::format("{} agree{}", with_verdict(corrected, Verdict::agrees).size(), undecided(corrected));
  if (refuted == 0)
    return fmt::format("answer    none of the {} predictions of corrected forms is refuted: {}\n", corrected.size(),
                       others);
  const std::string choice = of_choice.empty() ? ""
                             : of_these == 0   ? ", none of them of the choice"
                                               : fmt::format(", {} of them of the choice", of_these);
  return fmt::format("answer    {} of {} predictions of corrected forms are refuted{}; {}\n", refuted, corrected.size(),
                     choice, others);
}

std::string claim_summary(const Claims& claims, const Screen& screen) {
  const std::vector<std::string> techniques = validate::judged_candidates(claims);
  std::string text = answer_text(claims, techniques.empty() ? Claims{} : of_candidate(claims, techniques.front()));
  if (!techniques.empty()) text += choice_text(claims, techniques.front()) + others_text(claims, techniques);
  if (const Claims effects = starting_with(claims, "effects."); !effects.empty())
    text += fmt::format("effects   closed forms of a box tree with the effects below: {}{}\n", agreeing(effects),
                        failures(effects));
  const Claims others = formulas(claims);
  const std::string failed = those_that_are(Verdict::refuted, others, listed_by_technique);
  if (!failed.empty() || (!techniques.empty() && !others.empty()))
    text += fmt::format("formulas  on isotropic lines{}: {}{}{}\n",
                        techniques.empty() ? "" : " through these discs, most of them for uniform samples",
                        agreeing(others), undecided(others), failed);
  return wrapped(text + published_text(claims) + controls_text(claims), screen.text_width(), 10);
}

std::string known_text(double number, const char* shape) {
  return std::isfinite(number) ? fmt::format(fmt::runtime(shape), number) : "?";
}

Style style_of(Verdict verdict) {
  return verdict == Verdict::agrees ? Style::good : verdict == Verdict::refuted ? Style::bad : Style::doubtful;
}

std::string claim_table(const Claims& shown, const Screen& screen) {
  TextTable table({{.head = "claim", .align = Align::left},
                   {.head = "predicted"},
                   {.head = "observed"},
                   {.head = "±", .align = Align::left, .spare = 2},
                   {.head = "differs"},
                   {.head = "within", .spare = 3},
                   {.head = "detects", .spare = 1},
                   {.head = "verdict", .align = Align::left},
                   {.head = "control", .align = Align::left, .spare = 4}});
  for (const Claim& claim : shown)
    table.add({{claim.id},
               {known_text(claim.predicted, "{:.5g}")},
               {known_text(claim.observed.mean, "{:.5g}")},
               {known_text(claim.observed.standard_error, "{:.1g}")},
               {known_text(100 * claim.relative_difference, "{:+.2f}%")},
               {fmt::format("{:.2g}%", 100 * claim.tolerance)},
               {known_text(100 * claim.detectable, "{:.2g}%")},
               claim.documented ? TextCell{"refuted, as documented"}
                                : TextCell{std::string(name(claim.verdict)), style_of(claim.verdict)},
               {std::string(validate::control_name(claim.control_verdict)),
                claim.control_verdict == Verdict::refuted ? Style::plain : Style::doubtful}});
  return table.text(screen) +
         legend(screen,
                "±: one standard error of what was observed. differs: observed over predicted, less 1. within: a "
                "difference that still counts as agreement. detects: the smallest error of the formula that would have "
                "been refuted. control: whether the formula made wrong by just that much is caught (refuted). "
                "published: the paper's formula, corrected: ours. As documented: the corrected form predicts another "
                "number, and its header says what is wrong in the published one.");
}

std::string quantities(const Claims& claims, const Screen& screen) {
  std::vector<std::pair<std::string, std::string>> rows;
  std::size_t width = 0;
  for (const Claim& claim : claims) {
    if (!rows.empty() && rows.back().first == claim.stem()) continue;
    rows.emplace_back(claim.stem(), claim.quantity);
    width = std::max(width, claim.stem().size());
  }
  std::string text = "\n";
  for (const auto& [stem, quantity] : rows)
    text += wrapped(fmt::format("{:<{}}  {}", stem, width, quantity), screen.text_width(), width + 2);
  return text;
}

/// The line "errors", and what is missing.
std::string until_text(const std::vector<validate::Finding>& findings, const validate::FindingsTarget& target) {
  std::string missing;
  std::string dark;
  std::string fixed;
  const auto add = [](std::string& list, const std::string& one) { list += (list.empty() ? "" : "; ") + one; };
  std::size_t reached = 0;
  for (const validate::Finding& finding : findings) {
    const validate::Refinement& one = finding.refinement.value();
    if (one.reached)
      ++reached;
    else if (!one.more_lines)
      add(fixed, finding.id);
    else if (!std::isfinite(*one.more_lines))
      add(dark, fmt::format("{} (at most {:.2g} of its lines meet anything)", finding.id, one.share_bound.value_or(1)));
    else
      add(missing, fmt::format("{} (now {:.2g} %) about {:.2g} more lines, {:.2g} s", finding.id,
                               100 * one.relative_error, *one.more_lines, *one.more_seconds));
  }
  std::string text =
      fmt::format("errors    {} of {} counts are known within {:.2g} % ({:.3g} % confidence for all together)\n",
                  reached, findings.size(), 100 * target.relative_error, 100 * target.confidence);
  if (!missing.empty()) text += "          undecided, needs: " + missing + "\n";
  if (!dark.empty()) text += "          undecided, nothing was met: " + dark + "\n";
  if (!fixed.empty()) text += "          not more accurate with more lines: " + fixed + "\n";
  return text;
}

std::string where_worst(const validate::Deviation& row) {
  std::string place =
      fmt::format("D {}, n {:g}, d/r0 {:g}, {}", row.dimension, row.samples, row.disc_share, row.parameters);
  return row.sphere > 0 ? place + fmt::format(", i {}", row.sphere) : place;
}

std::string sweep_text(const validate::SweepResult& sweep, const Screen& screen) {
  TextTable table({{.head = "technique", .align = Align::left},
                   {.head = "quantity", .align = Align::left},
                   {.head = "form", .align = Align::left},
                   {.head = "compared", .spare = 2},
                   {.head = "median"},
                   {.head = "p95", .spare = 1},
                   {.head = "worst"},
                   {.head = "goal"},
                   {.head = "beyond"},
                   {.head = "worst at", .align = Align::left, .spare = 3}});
  for (const validate::DeviationSummary& summary : validate::summarise(sweep.deviations)) {
    if (summary.compared == 0) continue;
    table.add({{summary.technique},
               {summary.quantity},
               {std::string(name(summary.form))},
               {fmt::format("{}", summary.compared)},
               {fmt::format("{:.2f}%", 100 * summary.median)},
               {fmt::format("{:.1f}%", 100 * summary.p95)},
               {fmt::format("{:.1f}%", 100 * summary.worst), summary.met() ? Style::plain : Style::doubtful},
               {fmt::format("{:g}%", 100 * summary.goal.worst)},
               {fmt::format("{}", summary.beyond)},
               {where_worst(summary.worst_at)}});
  }
  return fmt::format("\n{} of {} workloads measured\n", sweep.measured, sweep.points) + table.text(screen) +
         legend(screen,
                "median, p95, worst: of the deviations of predictions from counts. goal: what the worst should not "
                "exceed. beyond: how many do. D: dimension of the samples, n: their number, d/r0: radius of the discs "
                "over that of the sphere around them, i: number of a nested sphere.");
}

}  // namespace

std::string text_of(const validate::ValidateAnswer& answer, const validate::FindingsTarget* target,
                    const std::string& scene, const Screen& screen) {
  std::string text = answer.claims.empty() ? "answer    no claim was judged\n" : claim_summary(answer.claims, screen);
  text += "\n" + wrapped((target == nullptr ? "" : until_text(answer.findings, *target)) + scene +
                             effects_line(answer.effects),
                         screen.text_width(), 10);
  if (!answer.shown.empty()) text += "\n" + claim_table(answer.shown, screen) + quantities(answer.shown, screen);
  if (answer.sweep) text += sweep_text(*answer.sweep, screen);
  return text;
}

}  // namespace detp::cli
