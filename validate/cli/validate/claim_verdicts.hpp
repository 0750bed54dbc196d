#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "detp/validate/claims/claim.hpp"
#include "detp/validate/cli/text/result.hpp"

/// What the verdicts on claims come to.
namespace detp::cli {

using Claims = std::vector<validate::Claim>;

template <class Condition>
[[nodiscard]] Claims those(const Claims& claims, const Condition& condition) {
  Claims found;
  std::copy_if(claims.begin(), claims.end(), std::back_inserter(found), condition);
  return found;
}

[[nodiscard]] Claims with_form(const Claims& claims, Form form);
[[nodiscard]] Claims with_verdict(const Claims& claims, validate::Verdict verdict);

/// The claims whose id starts with this text.
[[nodiscard]] Claims starting_with(const Claims& claims, const std::string& start);

/// "rebuild-time" of the id "rebuild-time.corrected".
[[nodiscard]] std::string stem(const validate::Claim& claim);

/// The techniques whose predictions by `choose` are claims, the fastest first; empty without a scene.
[[nodiscard]] std::vector<std::string> candidates(const Claims& claims);

/// The predictions of `choose` for a technique.
[[nodiscard]] Claims of_candidate(const Claims& claims, const std::string& technique);

/// The verdict on a negative control, which should be refuted: `caught` if it was, `missed` if the wrong formula agrees
/// with the counts, else `undecided`.
[[nodiscard]] std::string_view control_name(validate::Verdict verdict);

/// How many negative controls have this verdict.
[[nodiscard]] std::size_t controls(const Claims& claims, validate::Verdict verdict);

/// True if the claim is a published form that was refuted, and the corrected form of the same quantity predicts another
/// number. The header of the corrected form then says what is wrong in the published one.
[[nodiscard]] bool is_documented(const validate::Claim& claim, const Claims& claims);

/// `refuted` if a corrected form is refuted or a negative control missed. A refuted published form does not matter.
[[nodiscard]] ExitCode code_of(const Claims& claims);

/// The numbers of verdicts on corrected forms, published forms, controls and the predictions of the choice.
[[nodiscard]] Json claim_summary_json(const Claims& claims);

}  // namespace detp::cli
