#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "detp/model/vocabulary/vocabulary.hpp"

/// How results mark an extrapolated prediction (detp/model/extrapolation.hpp).
namespace detp::cli {

/// The keys "extrapolated", and "extrapolated_because" with the reasons.
[[nodiscard]] Json extrapolated_json(const std::vector<std::string>& reasons);

/// For text: why predictions are marked with ~. A reason that does not hold for all techniques marked has the names of
/// those for which it does. Empty where no prediction is extrapolated.
[[nodiscard]] std::string extrapolated_note(
    std::span<const std::pair<Technique, std::vector<std::string>>> predictions);

}  // namespace detp::cli
