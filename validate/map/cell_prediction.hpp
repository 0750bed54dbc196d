#pragma once

#include "detp/validate/choice/choice.hpp"

namespace detp::validate {

/// The choice for one cell of a map. Throws as choose, and std::invalid_argument if predicted times are 0 or not finite.
[[nodiscard]] Choice choose_for_cell(const Question& question, const CostTable& costs);

}  // namespace detp::validate
