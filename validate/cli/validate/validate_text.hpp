#pragma once

#include <string>

#include "detp/validate/claims/validation.hpp"
#include "detp/validate/cli/text/screen.hpp"

/// The answer of `detp validate` as text.
namespace detp::cli {

/// A summary: how many predictions are refuted; in a scene, which predictions of the choice, of other techniques and of the formulas; the
/// published forms; the negative controls. Then `scene`, which are lines about rays and discs; the effects; a table of the claims and
/// one of the sweep. `target`: what the answer was counted to, or null.
[[nodiscard]] std::string text_of(const validate::ValidateAnswer& answer, const validate::FindingsTarget* target,
                                  const std::string& scene, const Screen& screen);

}  // namespace detp::cli
