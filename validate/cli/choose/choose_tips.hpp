#pragma once

#include <cstddef>
#include <string>

#include "choose_report.hpp"

namespace detp::cli {

/// Appends `tips`, `tips_range` and `tips_seconds`.
void add_tips(Json& json, const ChooseAnswer& answer);

/// The line "tips": changes of one input that change the choice, and where no other technique wins.
[[nodiscard]] std::string tips_line(const ChooseAnswer& answer);

/// The line "tips", shorter: the techniques that are or may be faster elsewhere, at most `most` of them; if there are none, where no
/// other technique wins.
[[nodiscard]] std::string short_tips_line(const ChooseAnswer& answer, std::size_t most);

}  // namespace detp::cli
