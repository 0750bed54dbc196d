#pragma once

#include <string>

#include "choose_report.hpp"

namespace detp::cli {

/// Appends `tips`, `tips_range` and `tips_seconds`.
void add_tips(Json& json, const ChooseAnswer& answer);

/// The line "tips": changes of one input that change the choice, and where no other technique wins.
[[nodiscard]] std::string tips_line(const ChooseAnswer& answer);

}  // namespace detp::cli
