#include "validate_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace detp::cli {
namespace {

using validate::Claim;
using validate::Verdict;

template <class Condition>
Claims those(const Claims& claims, const Condition& condition) {
  Claims found;
  std::copy_if(claims.begin(), claims.end(), std::back_inserter(found), condition);
  return found;
}

Claims with_form(const Claims& claims, Form form) {
  return those(claims, [&](const Claim& claim) { return claim.form == form; });
}

Claims with_verdict(const Claims& claims, Verdict verdict) {
  return those(claims, [&](const Claim& claim) { return claim.verdict == verdict; });
}

/// The claims whose id starts with this text.
Claims starting_with(const Claims& claims, const std::string& start) {
  return those(claims, [&](const Claim& claim) { return claim.id.starts_with(start); });
}

/// The techniques whose predictions by `choose` are claims, the fastest first; empty without a scene.
std::vector<std::string> candidates(const Claims& claims) {
  std::vector<std::string> techniques;
  for (const Claim& claim : starting_with(claims, "choice."))
    if (techniques.empty() || techniques.back() != claim.technique) techniques.push_back(claim.technique);
  return techniques;
}

/// The predictions of `choose` for a technique.
Claims of_candidate(const Claims& claims, const std::string& technique) {
  return starting_with(claims, "choice." + technique + ".");
}

/// How many negative controls have this verdict.
std::size_t controls(const Claims& claims, Verdict verdict) {
  return those(claims, [&](const Claim& claim) { return claim.control_verdict == verdict; }).size();
}

Json verdicts_json(const Claims& claims) {
  Json json;
  for (const Verdict verdict : {Verdict::agrees, Verdict::refuted, Verdict::undecided})
    json[std::string(name(verdict))] = with_verdict(claims, verdict).size();
  return json;
}

}  // namespace

std::string stem(const Claim& claim) { return claim.id.substr(0, claim.id.rfind('.')); }

std::string_view control_name(Verdict verdict) {
  return verdict == Verdict::refuted ? "caught" : verdict == Verdict::agrees ? "missed" : "undecided";
}

bool is_documented(const Claim& claim, const Claims& claims) {
  return claim.form == Form::published && claim.verdict == Verdict::refuted &&
         std::any_of(claims.begin(), claims.end(), [&](const Claim& other) {
           return other.form == Form::corrected && stem(other) == stem(claim) && other.predicted != claim.predicted;
         });
}

ExitCode code_of(const Claims& claims) {
  const bool refuted = !with_verdict(with_form(claims, Form::corrected), Verdict::refuted).empty();
  return refuted || controls(claims, Verdict::agrees) > 0 ? ExitCode::refuted : ExitCode::done;
}

Json claim_summary_json(const Claims& claims) {
  const Claims published = with_form(claims, Form::published);
  Json json{{"corrected", verdicts_json(with_form(claims, Form::corrected))}, {"published", verdicts_json(published)}};
  json["published"]["documented"] =
      those(published, [&](const Claim& claim) { return is_documented(claim, claims); }).size();
  for (const Verdict verdict : {Verdict::refuted, Verdict::agrees, Verdict::undecided})
    json["controls"][std::string(control_name(verdict))] = controls(claims, verdict);
  const std::vector<std::string> techniques = candidates(claims);
  if (techniques.empty()) return json;
  const Claims of_choice = of_candidate(claims, techniques.front());
  Json choice{{"technique", techniques.front()}, {"parameters", of_choice.front().parameters}};
  choice.update(verdicts_json(of_choice));
  choice["refuted_claims"] = Json::array();
  for (const Claim& claim : with_verdict(of_choice, Verdict::refuted)) choice["refuted_claims"].push_back(claim.id);
  json["choice"] = std::move(choice);
  return json;
}

namespace {

/// Corrected forms that are neither of a candidate nor of the effects.
Claims formulas(const Claims& claims) {
  return those(claims, [](const Claim& claim) {
    return claim.form == Form::corrected && !claim.id.starts_with("choice.") && !claim.id.starts_with("effects.");
  });
}

/// "disc-tests (counted 1.3 times the prediction)"
std::string with_factor(const Claim& claim) {
  const std::string whole = stem(claim);
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
  const std::string whole = stem(claim);
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
  const Claims documented = those(published, [&](const Claim& claim) { return is_documented(claim, claims); });
  const Claims others = those(published, [&](const Claim& claim) { return !is_documented(claim, claims); });
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

}  // namespace

std::string summary_text(const Claims& claims, const Screen& screen) {
  const std::vector<std::string> techniques = candidates(claims);
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

}  // namespace detp::cli
