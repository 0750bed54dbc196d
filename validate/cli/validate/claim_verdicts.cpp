#include "claim_verdicts.hpp"

namespace detp::cli {
namespace {

using validate::Claim;
using validate::Verdict;

Json verdicts_json(const Claims& claims) {
  Json json;
  for (const Verdict verdict : {Verdict::agrees, Verdict::refuted, Verdict::undecided})
    json[std::string(name(verdict))] = with_verdict(claims, verdict).size();
  return json;
}

}  // namespace

Claims with_form(const Claims& claims, Form form) {
  return those(claims, [&](const Claim& claim) { return claim.form == form; });
}

Claims with_verdict(const Claims& claims, Verdict verdict) {
  return those(claims, [&](const Claim& claim) { return claim.verdict == verdict; });
}

Claims starting_with(const Claims& claims, const std::string& start) {
  return those(claims, [&](const Claim& claim) { return claim.id.starts_with(start); });
}

std::string stem(const Claim& claim) { return claim.id.substr(0, claim.id.rfind('.')); }

std::vector<std::string> candidates(const Claims& claims) {
  std::vector<std::string> techniques;
  for (const Claim& claim : starting_with(claims, "choice."))
    if (techniques.empty() || techniques.back() != claim.technique) techniques.push_back(claim.technique);
  return techniques;
}

Claims of_candidate(const Claims& claims, const std::string& technique) {
  return starting_with(claims, "choice." + technique + ".");
}

std::string_view control_name(Verdict verdict) {
  return verdict == Verdict::refuted ? "caught" : verdict == Verdict::agrees ? "missed" : "undecided";
}

std::size_t controls(const Claims& claims, Verdict verdict) {
  return those(claims, [&](const Claim& claim) { return claim.control_verdict == verdict; }).size();
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

}  // namespace detp::cli
