#pragma once

#include <string>

#include "claim_verdicts.hpp"
#include "detp/validate/cli/text/screen.hpp"

namespace detp::cli {

/// The answer of `validate` in a few lines: how many predictions are refuted; on a scene, which predictions of the choice,
/// of other techniques and of the formulas; the published forms; the negative controls.
[[nodiscard]] std::string summary_text(const Claims& claims, const Screen& screen);

}  // namespace detp::cli
