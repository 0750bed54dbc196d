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

/// For text: the reasons why predictions are marked with ~. A reason that does not apply to all marked techniques is
/// followed by the names of those to which it does. Empty if no prediction is extrapolated.
[[nodiscard]] std::string extrapolated_note(
    std::span<const std::pair<Technique, std::vector<std::string>>> predictions);

}  // namespace detp::cli
