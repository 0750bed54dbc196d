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

/// For text: a line for each reason, with the techniques whose rows are marked with ~ for it. Empty where none is.
[[nodiscard]] std::string extrapolated_lines(
    std::span<const std::pair<Technique, std::vector<std::string>>> predictions);

}  // namespace detp::cli
